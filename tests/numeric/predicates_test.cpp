// Oracle: rational arithmetic of Boost.Multiprecision.
#include "numeric/predicates.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::numeric {
namespace {

using Rational = boost::multiprecision::cpp_rational;

struct Rational3 {
  Rational x, y, z;
};

Rational3 difference(const Vec3& p, const Vec3& q) {
  return {Rational(p.x) - Rational(q.x), Rational(p.y) - Rational(q.y),
          Rational(p.z) - Rational(q.z)};
}

Rational dot(const Rational3& a, const Rational3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

int oracle_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Rational3 u = difference(b, a);
  const Rational3 v = difference(c, a);
  const Rational3 w = difference(d, a);
  return Rational(w.x * (u.y * v.z - u.z * v.y) + w.y * (u.z * v.x - u.x * v.z) +
                  w.z * (u.x * v.y - u.y * v.x))
      .sign();
}

int oracle_orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  return Rational((Rational(b.x) - Rational(a.x)) * (Rational(c.y) - Rational(a.y)) -
                  (Rational(b.y) - Rational(a.y)) * (Rational(c.x) - Rational(a.x)))
      .sign();
}

int oracle_dot(const Vec3& o, const Vec3& p, const Vec3& q) {
  return dot(difference(p, o), difference(q, o)).sign();
}

int oracle_cosine(const Vec3& o, const Vec3& p, const Vec3& q, double c2) {
  const Rational3 u = difference(p, o);
  const Rational3 v = difference(q, o);
  const Rational uv = dot(u, v);
  return Rational(uv * uv - Rational(c2) * dot(u, u) * dot(v, v)).sign();
}

// Numbers of very different kinds: small integers (exact ties), generic, almost equal, huge, tiny.
double random_number(Random& random, int kind) {
  const double u = random.uniform() - 0.5;
  switch (kind) {
    case 0:
      return static_cast<double>(random.below(5)) - 2;
    case 1:
      return u;
    case 2:  // a small grid, shaken in the last bits
      return (static_cast<double>(random.below(4)) + 1) *
             (1 + 0x1p-52 * static_cast<double>(random.below(3)));
    case 3:
      return 1e6 + static_cast<double>(random.below(3)) +
             0x1p-33 * static_cast<double>(random.below(3));
    case 4:
      return u * 1e300;
    case 5:
      return u * 1e-300;
    case 6:  // denormal
      return std::ldexp(static_cast<double>(random.below(9)) - 4, -1074);
    default:  // every magnitude at once
      return std::ldexp(u, static_cast<int>(random.below(2000)) - 1000);
  }
}

Vec3 random_point(Random& random, int kind) {
  const double x = random_number(random, kind);
  const double y = random_number(random, kind);
  return {x, y, random_number(random, kind)};
}

constexpr int kKinds = 8;

// Rational arithmetic takes its time on far exponents.
std::uint64_t count_of(int kind) { return kind < 4 ? 2000 : 200; }

TEST(Predicates, OrientationsEqualTheOracle) {
  std::array<int, 3> seen{};
  for (int kind = 0; kind < kKinds; ++kind) {
    for (std::uint64_t i = 0; i < count_of(kind); ++i) {
      Random random(static_cast<std::uint64_t>(kind), i);
      const Vec3 a = random_point(random, kind);
      const Vec3 b = random_point(random, kind);
      const Vec3 c = random_point(random, kind);
      Vec3 d = random_point(random, kind);
      // A point that is on the plane but for rounding.
      if (i % 3 == 0 && kind < 4) d = a + 0.25 * (b - a) + 0.625 * (c - a);
      const int sign = orient3d(a, b, c, d);
      EXPECT_EQ(sign, oracle_orient3d(a, b, c, d));
      EXPECT_EQ(sign, -orient3d(b, a, c, d));
      EXPECT_EQ(sign, -orient3d(d, b, c, a));
      ++seen[sign + 1];
      const Vec2 p = without(2, a);
      const Vec2 q = without(2, b);
      Vec2 r = without(2, c);
      if (i % 3 == 0 && kind < 4) r = {p.x + 3 * (q.x - p.x), p.y + 3 * (q.y - p.y)};
      EXPECT_EQ(orient2d(p, q, r), oracle_orient2d(p, q, r));
    }
  }
  for (const int count : seen) EXPECT_GT(count, 200);  // the test saw all three answers
}

TEST(Predicates, AnglesEqualTheOracle) {
  std::array<int, 3> seen{};
  for (int kind = 0; kind < kKinds; ++kind) {
    for (std::uint64_t i = 0; i < count_of(kind); ++i) {
      Random random(100 + static_cast<std::uint64_t>(kind), i);
      const Vec3 o = random_point(random, kind);
      const Vec3 p = random_point(random, kind);
      Vec3 q = random_point(random, kind);
      if (i % 3 == 0 && kind < 4) q = o + cross(p - o, q - o);  // right, but for rounding
      const int sign = dot_sign(o, p, q);
      EXPECT_EQ(sign, oracle_dot(o, p, q));
      ++seen[sign + 1];
      for (const double c2 : {0.0, 0.25, 0.75, 1.0, 0.5868240888334652, 1e-30})
        EXPECT_EQ(compare_squared_cosine(o, p, q, c2), oracle_cosine(o, p, q, c2));
    }
  }
  for (const int count : seen) EXPECT_GT(count, 200);
}

TEST(Predicates, SquaredCosineTies) {
  const Vec3 o{};
  EXPECT_EQ(compare_squared_cosine(o, {1, 1, 0}, {1, 2, 1}, 0.75), 0);  // 30 degrees
  const Vec3 a{1, 1, 0};
  const Vec3 b{1, 0, 1};
  EXPECT_EQ(compare_squared_cosine(o, a, b, 0.25), 0);  // 60 degrees
  const Vec3 c{1, 0, std::nextafter(1.0, 2)};
  EXPECT_EQ(compare_squared_cosine(o, a, c, 0.25), -1);
  const Vec3 d{1, 0, std::nextafter(1.0, 0)};
  EXPECT_EQ(compare_squared_cosine(o, a, d, 0.25), 1);
}

TEST(Predicates, CollinearInSpace) {
  EXPECT_TRUE(collinear({0, 0, 0}, {1, 2, 3}, {3, 6, 9}));
  EXPECT_FALSE(collinear({0, 0, 0}, {1, 2, 3}, {3, 6, std::nextafter(9.0, 10)}));
  EXPECT_TRUE(collinear({0, 0, 0}, {0, 0, 0}, {3, 6, 9}));
}

}  // namespace
}  // namespace nonobtuse::numeric
