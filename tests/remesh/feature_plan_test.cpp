// Where the vertices of a part with features go.
#include "remesh/feature_plan.h"

#include <gtest/gtest.h>

#include <vector>

#include "rdt/shapes.h"
#include "remesh/parts.h"

namespace nonobtuse::pipeline {
namespace {

TEST(FeaturePlan, FinePlacesHaveShorterEdges) {
  const TriangleMesh box = shapes::box(4, 4, 4);
  const RemeshOptions options;
  std::vector<Part> parts = connected_parts(box, {});
  find_features(box, options, parts);
  ASSERT_EQ(parts.size(), 1u);
  const Index n = 600;
  const FeaturePlan even = plan_features(parts[0], n, options);
  const Vec3 corner = even.input.surface.vertices[0];
  const FeaturePlan fine = plan_features(parts[0], n, options, {{corner, 0.3 * kEdgeLength}});
  EXPECT_TRUE(even.surface.size.empty());
  ASSERT_EQ(fine.surface.size.size(), fine.surface.vertices.size());
  // Sizes grow with the distance from the place, to more than those of the even mesh.
  const double reach = 0.7 / options.gradation * kEdgeLength;
  for (std::size_t v = 0; v < fine.surface.size.size(); ++v) {
    const double d = distance(fine.surface.vertices[v], corner);
    if (d == 0) {
      EXPECT_LE(fine.surface.size[v], 0.33);
    }
    if (d > 1.5 * reach) {
      EXPECT_GT(fine.surface.size[v], 1);
    }
  }
}

}  // namespace
}  // namespace nonobtuse::pipeline
