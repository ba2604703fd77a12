// Oracle: rational arithmetic of Boost.Multiprecision.
#include "numeric/expansion.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <utility>

#include "numeric/random.h"
#include "numeric/wide_integer.h"

using nonobtuse::numeric::Expansion;
using nonobtuse::numeric::Random;
using nonobtuse::numeric::WideInteger;
using Rational = boost::multiprecision::cpp_rational;

namespace {

// Values that overlap, cancel and leave gaps.
double random_value(Random& random) {
  const int exponent = static_cast<int>(random.below(60)) - 30;
  const double u =
      random.below(3) == 0 ? static_cast<double>(random.below(9)) - 4 : random.uniform() - 0.5;
  return std::ldexp(u, exponent);
}

// The same random expression of + - * in both arithmetics.
std::pair<Expansion, Rational> random_expression(Random& random, int depth) {
  if (depth == 0) {
    const double x = random_value(random);
    const double y = random_value(random);
    switch (random.below(3)) {
      case 0:
        return {Expansion(x), Rational(x)};
      case 1:
        return {Expansion::difference(x, y), Rational(x) - Rational(y)};
      default:
        return {Expansion::product(x, y), Rational(x) * Rational(y)};
    }
  }
  const auto [a, p] = random_expression(random, depth - 1);
  const auto [b, q] = random_expression(random, depth - 1);
  const double s = random_value(random);
  switch (random.below(4)) {
    case 0:
      return {a + b, p + q};
    case 1:
      return {a - b, p - q};
    case 2:
      return {a * b, p * q};
    default:
      return {a * s, p * Rational(s)};
  }
}

}  // namespace

TEST(Expansion, CancellationIsExact) {
  const Expansion big(1e20);
  const Expansion tiny(1e-20);
  EXPECT_EQ((big + tiny - big).sign(), 1);
  EXPECT_EQ((big + tiny - big - tiny).sign(), 0);
  const Expansion third = Expansion::product(1.0 / 3, 3.0) - Expansion(1.0);
  EXPECT_EQ(third.sign(), -1);  // 1/3 rounds down
}

TEST(Expansion, ExpressionsEqualRationalArithmetic) {
  for (std::uint64_t i = 0; i < 4000; ++i) {
    Random random(1, i);
    const auto [a, p] = random_expression(random, static_cast<int>(i % 4));
    EXPECT_EQ(a.sign(), p.sign());
    const double nearest = static_cast<double>(p);
    EXPECT_NEAR(a.estimate(), nearest, 1e-14 * std::abs(nearest));
    // What is left after taking the estimate away is tested down to its last bit.
    const Expansion rest = a - Expansion(a.estimate());
    EXPECT_EQ(rest.sign(), Rational(p - Rational(a.estimate())).sign());
    EXPECT_EQ((a * a - a * a).sign(), 0);
  }
}

TEST(WideInteger, ExpressionsEqualRationalArithmetic) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(2, i);
    const auto value = [&] {
      const double u = std::ldexp(random.uniform() - 0.5, static_cast<int>(random.below(400)));
      return random.below(5) == 0 ? 0 : u;
    };
    const double a = value();
    const double b = value();
    const double c = random.below(2) == 0 ? a : value();
    const auto wide = [](double x) { return WideInteger::scaled(x, -120); };
    const Rational exact = Rational(a) * Rational(b) - Rational(c) * Rational(b) + Rational(c) * a;
    EXPECT_EQ((wide(a) * wide(b) - wide(c) * wide(b) + wide(c) * wide(a)).sign(), exact.sign());
    EXPECT_EQ((wide(a) * wide(b) - wide(b) * wide(a)).sign(), 0);
    EXPECT_EQ((wide(a) + wide(b) - wide(c)).sign(),
              Rational(Rational(a) + Rational(b) - Rational(c)).sign());
  }
}
