// Corners that are listed instead of mended: what edges of a frozen boundary leave room for.
#include "remesh/unavoidable_corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nonobtuse/certificate.h"
#include "nonobtuse/remesh.h"
#include "numeric/random.h"
#include "rdt/shapes.h"

namespace nonobtuse::pipeline {
namespace {

TEST(UnavoidableCorners, NoFanExceedsTheLargestLengthRatio) {
  numeric::Random random(3, 0);
  const auto between = [&](int low, int high) {
    return low + static_cast<int>(random.uniform() * (high - low + 1));
  };
  const double radian = 3.14159265358979323846 / 180;
  double most = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    int sum = 0;
    double ratio = 1;
    for (int left = between(1, 5); left > 0; --left) {
      const int corner = between(31, 89);
      if (sum + corner > 360) break;
      const int b = between(std::max(31, 91 - corner), std::min(89, 149 - corner));
      sum += corner;
      ratio *= std::sin(b * radian) / std::sin((180 - corner - b) * radian);
    }
    const double bound = largest_length_ratio(sum);
    ASSERT_LE(ratio, bound * (1 + 1e-12)) << sum;
    most = std::max(most, ratio / bound);
  }
  EXPECT_GT(most, 0.9);  // and some fans come near it
  EXPECT_EQ(largest_length_ratio(20), 0);
  EXPECT_LT(largest_length_ratio(180), 8);
  EXPECT_GT(largest_length_ratio(180), 7);
}

// A square with a short edge in a corner of its frozen boundary, and without.
TEST(UnavoidableCorners, AreListedOnlyWhereFrozenEdgesDifferTooMuch) {
  for (const bool uneven : {true, false}) {
    SCOPED_TRACE(uneven);
    TriangleMesh m = shapes::square(10);
    if (uneven)
      for (Vec3& v : m.vertices)
        if (v.y == 0 && std::abs(v.x - 0.1) < 1e-9) v.x = 0.01;
    RemeshOptions options;
    options.vertices = 150;
    options.boundary = Boundary::Freeze;
    const RemeshResult result = remesh(m, options);
    const Certificate promise = certify(result.mesh, {30, 90});
    EXPECT_TRUE(certified_but_for_narrow_corners(result.mesh, promise, result.narrow_corners));
    EXPECT_EQ(result.narrow_corners.empty(), !uneven);
    for (const NarrowCorner& c : result.narrow_corners)
      EXPECT_LT(length(result.mesh.vertices[c.vertex]), 0.02);
  }
}

}  // namespace
}  // namespace nonobtuse::pipeline
