// How many triangles share the angle of a sector.
#include "mesh/sector_valence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numeric/random.h"
#include "numeric/vec3.h"

namespace {

using namespace nonobtuse;

TEST(SectorValence, SharesTheAngle) {
  for (double degrees = 31; degrees < 720; degrees += 0.37) {
    const mesh::ValenceRange range = mesh::sector_valence(degrees);
    EXPECT_LE(range.least, range.best);
    EXPECT_LE(range.best, range.most);
    for (int valence = range.least; valence <= range.most; ++valence) {
      const double mean = degrees / (valence - 1);
      EXPECT_GE(mean, 30);
      EXPECT_LT(mean, 90);
    }
    // At 60 degrees each nothing is better.
    if (std::abs(degrees / (range.best - 1) - 60) > 30) {
      ADD_FAILURE() << degrees << " degrees";
    }
  }
  EXPECT_EQ(mesh::sector_valence(20).most, 2);
  EXPECT_EQ(mesh::sector_valence(90).least, 3);
  EXPECT_EQ(mesh::sector_valence(90).most, 3);
  EXPECT_EQ(mesh::sector_valence(180).least, 4);
  EXPECT_EQ(mesh::sector_valence(180).most, 5);
  EXPECT_EQ(mesh::sector_valence(360).best, 7);
}

TEST(SectorValence, AnglesAreThoseOfTheMathLibrary) {
  numeric::Random random(11);
  const auto point = [&] {
    return Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
  };
  for (int i = 0; i < 3000; ++i) {
    const Vec3 apex = point(), p = point();
    // Also angles near 0 and 180 degrees.
    const double near = i % 3 == 0 ? 1 : 1e-4;
    const Vec3 q = apex + (i % 2 == 0 ? 0.7 : -0.7) * (p - apex) + near * point();
    const Vec3 a = p - apex, b = q - apex;
    const double expected = std::atan2(length(cross(a, b)), dot(a, b)) * 57.29577951308232;
    EXPECT_NEAR(mesh::corner_degrees(apex, p, q), expected, 1e-7);
  }
  EXPECT_EQ(mesh::corner_degrees({}, {}, {1, 0, 0}), 0);
  EXPECT_NEAR(mesh::corner_degrees({}, {1, 0, 0}, {-1, 0, 0}), 180, 1e-7);
}

}  // namespace
