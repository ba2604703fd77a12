#include "nonobtuse/certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "meshes.h"
#include "nonobtuse/error.h"
#include "nonobtuse/quality.h"

namespace nonobtuse::quality {
namespace {

TriangleMesh one(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {{0, 1, 2}}}; }

bool certified(const TriangleMesh& mesh, double min_angle, double max_angle) {
  return certify(mesh, {min_angle, max_angle}).certified;
}

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

// Powers of two that keep every coordinate normal.
const double kScales[] = {1, 0x1p-900, 0x1p-300, 0x1p300, 0x1p1000};

TEST(Certify, RightAngleToTheLastBit) {
  for (const double scale : kScales) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto triangle = [&](double x) {
        Vec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {x, 1, 0}};
        return transformed(one(p[corner], p[(corner + 1) % 3], p[(corner + 2) % 3]), scale);
      };
      EXPECT_FALSE(certified(triangle(0), 0, 90));
      EXPECT_FALSE(certified(triangle(-0x1p-52), 0, 90));
      EXPECT_TRUE(certified(triangle(0x1p-52), 0, 90));
    }
  }
}

TEST(Certify, ThirtyDegreesToTheLastBit) {
  // (1, 1, 0) and (1, 2, 1) are at exactly 30 degrees.
  for (const double scale : kScales) {
    const auto triangle = [&](double z) {
      return transformed(one({0, 0, 0}, {2, 2, 0}, {1, 2, z}), scale);
    };
    EXPECT_TRUE(certify(triangle(1)).too_small.empty());
    EXPECT_FALSE(certify(triangle(down(1))).too_small.empty());
    EXPECT_TRUE(certify(triangle(up(1))).too_small.empty());
  }
}

TEST(Certify, SixtyDegreesToTheLastBit) {
  const auto triangle = [](double z) { return one({1, 0, 0}, {0, 1, 0}, {0, 0, z}); };
  EXPECT_TRUE(certified(triangle(1), 60, 90));
  EXPECT_FALSE(certified(triangle(up(1)), 60, 90));
  EXPECT_FALSE(certified(triangle(down(1)), 60, 90));
}

// At bounds whose cosine is no double the decision errs to the safe side, by less than 1e-10.
TEST(Certify, OtherBoundsAreTight) {
  for (const double angle : {40.0, 46.0, 55.5, 0.5}) {
    const double base = 90 - angle / 2;  // two equal sides
    const auto isosceles = [&](double apex) {
      const double half = apex / 2 * std::numbers::pi / 180;
      return one({0, 0, 0}, {std::cos(half), -std::sin(half), 0},
                 {std::cos(half), std::sin(half), 0});
    };
    EXPECT_TRUE(certified(isosceles(angle + 1e-10), angle, 90));
    EXPECT_FALSE(certified(isosceles(angle - 1e-10), angle, 90));
    if (base > 60 && base < 90 - 1e-9) {
      EXPECT_TRUE(certified(isosceles(angle + 1e-10), 0, base));
      EXPECT_FALSE(certified(isosceles(angle - 1e-10), 0, base));
    }
  }
}

TEST(Certify, TrianglesWithoutAreaBreakBothBounds) {
  for (const double scale : kScales) {
    for (const TriangleMesh& flat :
         {one({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), one({0, 0, 0}, {0, 0, 0}, {1, 2, 3}),
          one({1, 2, 3}, {0, 0, 0}, {1, 2, 3}), one({1, 2, 3}, {1, 2, 3}, {1, 2, 3})}) {
      const Certificate c = certify(transformed(flat, scale), {0, 90});
      EXPECT_FALSE(c.certified);
      EXPECT_EQ(c.too_large.size(), 1u);
      EXPECT_EQ(c.too_small.size(), 1u);
    }
  }
}

TEST(Certify, WorstFirstThenByIndex) {
  TriangleMesh mesh;
  for (const double x : {0.5, -1.0, -3.0, -1.0, -0.25})
    mesh = together(std::move(mesh), one({0, 0, 0}, {1, 0, 0}, {x, 1, 0}));
  const Certificate c = certify(mesh, {0, 90});
  EXPECT_EQ(c.too_large, (std::vector<Index>{2, 1, 3, 4}));
  EXPECT_EQ(c.triangles, 5);
}

TEST(Certify, ScalesByPowersOfTwoAndPermutationsChangeNothing) {
  TriangleMesh mesh = plane(9, 9, 0.3);  // all right angles
  numeric::Random random(1);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 2)
    mesh.vertices[v].x += random.uniform() - 0.5;
  const Certificate expected = certify(mesh);
  ASSERT_FALSE(expected.too_large.empty());
  ASSERT_LT(expected.too_large.size(), mesh.triangles.size());
  for (const double scale : kScales) {
    const Certificate c = certify(transformed(mesh, scale));
    EXPECT_EQ(c.too_large, expected.too_large);
    EXPECT_EQ(c.too_small, expected.too_small);
  }
  const Certificate c = certify(permuted(mesh, 3));
  EXPECT_EQ(c.too_large.size(), expected.too_large.size());
  EXPECT_EQ(c.too_small.size(), expected.too_small.size());
}

TEST(Certify, AgreesWithTheAngleFigures) {
  const TriangleMesh sphere = icosphere(3);
  const AngleQuality q = measure_angles(sphere);
  EXPECT_TRUE(certified(sphere, q.min_angle - 1e-9, q.max_angle + 1e-9));
  EXPECT_FALSE(certified(sphere, q.min_angle + 1e-9, 90));
  EXPECT_FALSE(certified(sphere, 0, q.max_angle - 1e-9));
}

TEST(Certify, NothingIsNotCertified) { EXPECT_FALSE(certify(TriangleMesh{}).certified); }

TEST(Certify, RefusesWhatItCannotDecide) {
  const TriangleMesh good = one({0, 0, 0}, {1, 0, 0}, {0.5, 1, 0});
  for (const CertificateBounds bounds :
       {CertificateBounds{-1, 90}, CertificateBounds{61, 90}, CertificateBounds{30, 60},
        CertificateBounds{30, 91}, CertificateBounds{std::nan(""), 90}})
    EXPECT_THROW((void)certify(good, bounds), InvalidInput);
  TriangleMesh bad = good;
  bad.triangles.push_back({0, 1, 3});
  try {
    (void)certify(bad);
    ADD_FAILURE() << "index out of range accepted";
  } catch (const InvalidInput& e) {
    EXPECT_EQ(e.element(), 1);
  }
  bad = good;
  bad.vertices[2].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)certify(bad), InvalidInput);
}

}  // namespace
}  // namespace nonobtuse::quality
