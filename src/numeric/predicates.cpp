// Filters: forward error bounds for sums of products of rounded differences, after Shewchuk 1997
// (section 4), rounded up. A result outside the safe range of exponents fails every comparison,
// NaN included, and goes to the exact path.
#include "numeric/predicates.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "numeric/expansion.h"
#include "numeric/vec3.h"
#include "numeric/wide_integer.h"

namespace nonobtuse::numeric {

namespace {

constexpr double kUnit = 0x1p-53;
// Above it no product of the filters has lost bits to underflow that matter.
constexpr double kSafe = 1e-250;

int sign_of(double x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

// Decides by decide(number), where number(x) makes an exact number, proportional to the double x,
// of a type with +, -, * and sign().
template <class Decide>
int exactly(std::initializer_list<double> values, const Decide& decide) {
  int high = -2000;
  int low = 2000;
  for (const double x : values) {
    if (x == 0) continue;
    int exponent = 0;
    std::frexp(x, &exponent);
    high = std::max(high, exponent);
    low = std::min(low, exponent);
  }
  // Of degree 4 the last bit is then worth 2^(4 (-150 - 53)), well above 2^-1074.
  if (high - low <= 150)
    return decide([high](double x) { return Expansion(std::ldexp(x, -high)); });
  return decide([low](double x) { return WideInteger::scaled(x, low - 53); });
}

template <class T>
struct Exact3 {
  T x, y, z;
};

template <class Number>
auto difference(const Vec3& p, const Vec3& q, const Number& number) {
  using T = decltype(number(0.0));
  return Exact3<T>{number(p.x) - number(q.x), number(p.y) - number(q.y), number(p.z) - number(q.z)};
}

template <class T>
T exact_dot(const Exact3<T>& a, const Exact3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

struct FilteredDot {
  double value = 0;
  double magnitude = 0;  // the same sum of absolute values
};

FilteredDot filtered_dot(const Vec3& u, const Vec3& v) {
  const double x = u.x * v.x;
  const double y = u.y * v.y;
  const double z = u.z * v.z;
  return {x + y + z, std::abs(x) + std::abs(y) + std::abs(z)};
}

}  // namespace

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b.x - a.x) * (c.y - a.y);
  const double right = (b.y - a.y) * (c.x - a.x);
  const double det = left - right;
  const double magnitude = std::abs(left) + std::abs(right);
  if (magnitude > kSafe && std::abs(det) > 4 * kUnit * magnitude) return sign_of(det);
  if (a == b || b == c || c == a) return 0;
  return exactly({a.x, a.y, b.x, b.y, c.x, c.y}, [&](const auto& number) {
    const auto ax = number(a.x);
    const auto ay = number(a.y);
    return ((number(b.x) - ax) * (number(c.y) - ay) - (number(b.y) - ay) * (number(c.x) - ax))
        .sign();
  });
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = d - a;
  const double yz = u.y * v.z;
  const double zy = u.z * v.y;
  const double zx = u.z * v.x;
  const double xz = u.x * v.z;
  const double xy = u.x * v.y;
  const double yx = u.y * v.x;
  const double det = w.x * (yz - zy) + w.y * (zx - xz) + w.z * (xy - yx);
  const double magnitude = std::abs(w.x) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(w.y) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(w.z) * (std::abs(xy) + std::abs(yx));
  // Bits lost to underflow in the products of u and v count |w| times.
  const double safe = kSafe * std::max({1.0, std::abs(w.x), std::abs(w.y), std::abs(w.z)});
  if (magnitude > safe && std::abs(det) > 9 * kUnit * magnitude) return sign_of(det);
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  const auto equal = [](double p, double q, double r, double s) {
    return p == q && p == r && p == s;
  };
  if (equal(a.x, b.x, c.x, d.x) || equal(a.y, b.y, c.y, d.y) || equal(a.z, b.z, c.z, d.z)) return 0;
  return exactly({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z},
                 [&](const auto& number) {
                   const auto e = difference(b, a, number);
                   const auto f = difference(c, a, number);
                   const auto g = difference(d, a, number);
                   return (g.x * (e.y * f.z - e.z * f.y) + g.y * (e.z * f.x - e.x * f.z) +
                           g.z * (e.x * f.y - e.y * f.x))
                       .sign();
                 });
}

int dot_sign(const Vec3& apex, const Vec3& p, const Vec3& q) {
  const FilteredDot d = filtered_dot(p - apex, q - apex);
  if (d.magnitude > kSafe && std::abs(d.value) > 8 * kUnit * d.magnitude) return sign_of(d.value);
  return exactly({apex.x, apex.y, apex.z, p.x, p.y, p.z, q.x, q.y, q.z}, [&](const auto& number) {
    return exact_dot(difference(p, apex, number), difference(q, apex, number)).sign();
  });
}

int compare_squared_cosine(const Vec3& apex, const Vec3& p, const Vec3& q, double squared_cosine) {
  const Vec3 u = p - apex;
  const Vec3 v = q - apex;
  const double uu = squared_length(u);
  const double vv = squared_length(v);
  const double uv = dot(u, v);
  const double magnitude = uu * vv;
  const double value = uv * uv - squared_cosine * magnitude;
  // |error of uv| <= 8 ulps of |u||v|, twice that for its square; 10 ulps for the other side.
  if (uu > kSafe && vv > kSafe && magnitude > kSafe && std::abs(value) > 64 * kUnit * magnitude)
    return sign_of(value);
  // squared_cosine = numerator / denominator, both integers that doubles hold.
  int exponent = 0;
  const double numerator = std::ldexp(std::frexp(squared_cosine, &exponent), 53);
  const double denominator = std::ldexp(1.0, 53 - exponent);
  return exactly({apex.x, apex.y, apex.z, p.x, p.y, p.z, q.x, q.y, q.z}, [&](const auto& number) {
    using T = decltype(number(0.0));
    const auto e = difference(p, apex, number);
    const auto f = difference(q, apex, number);
    const T product = exact_dot(e, f);
    T top;
    T bottom;
    if constexpr (std::is_same_v<T, Expansion>) {
      top = T(numerator);
      bottom = T(denominator);
    } else {
      top = T::scaled(numerator, 0);
      bottom = T::scaled(denominator, 0);
    }
    return (bottom * (product * product) - top * (exact_dot(e, e) * exact_dot(f, f))).sign();
  });
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orient2d(without(axis, a), without(axis, b), without(axis, c)) != 0) return false;
  return true;
}

}  // namespace nonobtuse::numeric
