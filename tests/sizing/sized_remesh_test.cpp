// The whole call with sizing: the field is realised, and steep fields keep the promise.
#include <gtest/gtest.h>

#include "nonobtuse/error.h"
#include "nonobtuse/quality.h"
#include "nonobtuse/remesh.h"
#include "nonobtuse/sample.h"
#include "sizing/sized_surfaces.h"

namespace nonobtuse::sizing {
namespace {

RemeshOptions given(const TriangleMesh& mesh, double ratio, double half_width, Index n) {
  RemeshOptions options;
  options.vertices = n;
  options.sizing = Sizing::Given;
  options.target_lengths = test::steep_field(mesh.vertices, ratio, -half_width, half_width);
  return options;
}

void expect_sound(const TriangleMesh& input, Index n, const RemeshResult& result) {
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_EQ(result.mesh.vertices.size(), n);
  EXPECT_EQ(measure_topology(result.mesh).euler_characteristic,
            measure_topology(input).euler_characteristic);
  EXPECT_EQ(measure_topology(result.mesh).nonmanifold_edges, 0);
}

TEST(SizedRemesh, EdgesFollowTheFieldOnASphere) {
  const TriangleMesh ball = test::sphere(5);
  const RemeshResult result = remesh(ball, given(ball, 4, 0.8, 1500));
  expect_sound(ball, 1500, result);
  EXPECT_EQ(result.status, Status::Converged);
  EXPECT_NEAR(result.size_ratio.median, 1, 0.03);
  EXPECT_GT(result.size_ratio.percentile_5, 0.8);
  EXPECT_LT(result.size_ratio.percentile_95, 1.25);
  // Independently of the ratio: four times as long at one pole as at the other.
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (const Triangle& t : result.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = result.mesh.vertices[t[k]], b = result.mesh.vertices[t[mesh::next(k)]];
      if (std::abs(a.z + b.z) < 1.8) continue;
      sum[a.z > 0] += distance(a, b);
      count[a.z > 0] += 1;
    }
  EXPECT_NEAR((sum[1] / count[1]) / (sum[0] / count[0]), 4, 0.5);
}

// Over a tenth of the sphere's diameter.
TEST(SizedRemesh, SteepFieldsKeepThePromise) {
  const TriangleMesh ball = test::sphere(5);
  for (const double ratio : {10.0, 100.0})
    expect_sound(ball, 3000, remesh(ball, given(ball, ratio, 0.1, 3000)));
}

TEST(SizedRemesh, FeaturesAndCurvatureReachTheGoal) {
  const TriangleMesh input = sample_surface(32);
  for (const Sizing sizing : {Sizing::LocalFeatureSize, Sizing::Curvature}) {
    const RemeshResult result = remesh(input, {.vertices = 1500, .sizing = sizing});
    expect_sound(input, 1500, result);
    EXPECT_EQ(result.status, Status::Converged);
    EXPECT_NEAR(result.size_ratio.median, 1, 0.05);
  }
}

TEST(SizedRemesh, LengthsAloneSayHowManyVertices) {
  const TriangleMesh ball = test::sphere(4);
  RemeshOptions options;
  options.sizing = Sizing::Given;
  options.target_lengths.assign(ball.vertices.size(), 0.12);
  const RemeshResult result = remesh(ball, options);
  EXPECT_NEAR(static_cast<double>(result.mesh.vertices.size()),
              4 * M_PI * 2 / std::sqrt(3.0) / (0.12 * 0.12), 10);
  EXPECT_NEAR(result.size_ratio.median, 1, 0.03);
}

TEST(SizedRemesh, ComponentsShareVerticesByTheField) {
  TriangleMesh two = test::sphere(4);
  const TriangleMesh ball = two;
  const auto shift = static_cast<Index>(ball.vertices.size());
  for (const Vec3& v : ball.vertices) two.vertices.push_back(v + Vec3{3, 0, 0});
  for (const Triangle& t : ball.triangles)
    two.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  RemeshOptions options{.vertices = 1000, .sizing = Sizing::Given};
  options.target_lengths.assign(two.vertices.size(), 1);
  for (Index v = shift; v < 2 * shift; ++v) options.target_lengths[v] = 2;
  const RemeshResult result = remesh(two, options);
  expect_sound(two, 1000, result);
  Index right = 0;
  for (const Vec3& v : result.mesh.vertices) right += v.x > 1.5;
  EXPECT_EQ(right, 200);  // a quarter as many as on the left
}

TEST(SizedRemesh, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh input = sample_surface(24);
  const RemeshOptions options{.vertices = 800, .sizing = Sizing::LocalFeatureSize};
  const RemeshResult one = remesh(input, options, {.threads = 1});
  const RemeshResult other = remesh(input, options, {.threads = 3});
  EXPECT_EQ(one.mesh.vertices, other.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
}

TEST(SizedRemesh, RefusesFieldsItCannotUse) {
  const TriangleMesh ball = test::sphere(2);
  RemeshOptions options{.vertices = 200, .sizing = Sizing::Given};
  options.target_lengths.assign(3, 1);
  EXPECT_THROW(remesh(ball, options), InvalidInput);
  options.target_lengths.assign(ball.vertices.size(), 1);
  options.target_lengths[5] = -1;
  try {
    remesh(ball, options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.element(), 5);
  }
  options.target_lengths[5] = 1;
  options.gradation = 0;
  EXPECT_THROW(remesh(ball, options), InvalidInput);
}

}  // namespace
}  // namespace nonobtuse::sizing
