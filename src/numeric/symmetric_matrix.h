// Symmetric 3 x 3 matrices, as sums of multiples of the identity and of outer products.
#pragma once

#include "numeric/vec3.h"

namespace nonobtuse::numeric {

struct SymmetricMatrix {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add_identity(double factor) {
    xx += factor;
    yy += factor;
    zz += factor;
  }
  /// Adds factor v v^T.
  void add_outer(double factor, const Vec3& v) {
    xx += factor * v.x * v.x;
    yy += factor * v.y * v.y;
    zz += factor * v.z * v.z;
    xy += factor * v.x * v.y;
    xz += factor * v.x * v.z;
    yz += factor * v.y * v.z;
  }
};

inline Vec3 operator*(const SymmetricMatrix& m, const Vec3& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// Two unit vectors that complete the unit vector n to an orthonormal basis (Duff et al., Building
/// an orthonormal basis, revisited, 2017).
struct TangentBasis {
  Vec3 u;
  Vec3 v;
};
inline TangentBasis tangent_basis(const Vec3& n) {
  const double sign = n.z < 0 ? -1 : 1;
  const double a = -1 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

/// The x perpendicular to the unit vector n with P m x = P v, P = I - n n^T: the solution inside
/// the tangent plane. `m` positive definite there; zero otherwise.
inline Vec3 solve_tangential(const SymmetricMatrix& m, const Vec3& n, const Vec3& v) {
  const TangentBasis t = tangent_basis(n);
  const Vec3 mu = m * t.u;
  const Vec3 mv = m * t.v;
  const double a = dot(t.u, mu);
  const double b = dot(t.u, mv);
  const double c = dot(t.v, mv);
  const double det = a * c - b * b;
  if (!(det > 0)) return {};
  const double p = dot(t.u, v);
  const double q = dot(t.v, v);
  return ((c * p - b * q) / det) * t.u + ((a * q - b * p) / det) * t.v;
}

}  // namespace nonobtuse::numeric
