// With squared edges a, b, c, S = 2(ab+bc+ca) - (a^2+b^2+c^2) = 16 area^2 and u_a = b+c-a:
//   cot_a = u_a / sqrt(S),  cos_a = u_a / (2 sqrt(bc)),  dS/da = 2 u_a.
// CVT: sum_k a_k^2/16 (cot_k/2 + cot_k^3/6), the energy of the Voronoi pieces of an acute triangle
//   (Du, Faber, Gunzburger 1999, integrated piece by piece).
// Circumcentre: R^2 - 2Rr = abc/S - sqrt(abc)/(sqrt a + sqrt b + sqrt c), by Euler the squared
//   distance of circumcentre and incentre (Sieger, Alliez, Botsch, Optimizing Voronoi diagrams for
//   polygonal finite element computations, 2010).
// Hinge: sum_k min(0, cos_k - cos largest)^2 + max(0, cos_k - cos smallest)^2 (ours).
#include "energy/mesh_shape.h"

#include <limits>

#include "mesh/surface.h"

namespace nonobtuse::energy {
namespace {

using mesh::next;
using mesh::previous;
using Triple = std::array<double, 3>;

double cvt(const Triple& s, const Triple& u, double root, double weight, Triple* derivative) {
  double energy = 0, slope_sum = 0, slope_u = 0;
  Triple slope{}, direct{};
  for (int k = 0; k < 3; ++k) {
    const double c = u[k] / root;
    const double poly = c * (0.5 + c * c / 6);
    energy += s[k] * s[k] / 16 * poly;
    direct[k] = s[k] / 8 * poly;
    slope[k] = s[k] * s[k] / 32 * (1 + c * c);
    slope_sum += slope[k];
    slope_u += slope[k] * u[k];
  }
  if (derivative) {
    const double cubed = slope_u / (root * root * root);
    for (int k = 0; k < 3; ++k)
      (*derivative)[k] += weight * (direct[k] + (slope_sum - 2 * slope[k]) / root - u[k] * cubed);
  }
  return weight * energy;
}

double circumcentre(const Triple& s, const Triple& u, const Triple& l, double area16, double weight,
                    Triple* derivative) {
  const double radius2 = s[0] * s[1] * s[2] / area16;
  const double product = l[0] * l[1] * l[2];
  const double perimeter = l[0] + l[1] + l[2];
  const double twice_rr = product / perimeter;
  if (derivative)
    for (int k = 0; k < 3; ++k)
      (*derivative)[k] += weight * (radius2 / s[k] - 2 * u[k] * radius2 / area16 -
                                    twice_rr / (2 * s[k]) + twice_rr / (2 * perimeter * l[k]));
  return weight * (radius2 - twice_rr);
}

double hinge(const Triple& s, const Triple& u, const Triple& l, const ShapeWeights& weights,
             Triple* derivative) {
  double energy = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = next(k), j = previous(k);
    const double half = 1 / (2 * l[i] * l[j]);
    const double cosine = u[k] * half;
    double excess = 0;
    if (cosine < weights.cos_largest)
      excess = cosine - weights.cos_largest;
    else if (cosine > weights.cos_smallest)
      excess = cosine - weights.cos_smallest;
    else
      continue;
    energy += weights.hinge * excess * excess;
    if (derivative) {
      const double slope = 2 * weights.hinge * excess;
      (*derivative)[k] -= slope * half;
      (*derivative)[i] += slope * (half - cosine / (2 * s[i]));
      (*derivative)[j] += slope * (half - cosine / (2 * s[j]));
    }
  }
  return energy;
}

}  // namespace

double triangle_shape(const Triple& s, const ShapeWeights& weights, Triple* derivative) {
  const Triple u{s[1] + s[2] - s[0], s[2] + s[0] - s[1], s[0] + s[1] - s[2]};
  const double area16 = u[0] * u[1] + u[1] * u[2] + u[2] * u[0];
  const double longest = std::max(s[0], std::max(s[1], s[2]));
  if (!(area16 > 1e-10 * longest * longest)) return std::numeric_limits<double>::infinity();
  const Triple l{std::sqrt(s[0]), std::sqrt(s[1]), std::sqrt(s[2])};
  if (derivative) *derivative = {0, 0, 0};
  double energy = 0;
  if (weights.cvt != 0) energy += cvt(s, u, std::sqrt(area16), weights.cvt, derivative);
  if (weights.circumcentre != 0)
    energy += circumcentre(s, u, l, area16, weights.circumcentre, derivative);
  if (weights.hinge != 0) energy += hinge(s, u, l, weights, derivative);
  return energy;
}

double triangle_shape(const Vec3& p0, const Vec3& p1, const Vec3& p2, const ShapeWeights& weights,
                      std::array<Vec3, 3>& gradient) {
  const Vec3 e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
  Triple d{0, 0, 0};
  const double energy =
      triangle_shape({squared_length(e0), squared_length(e1), squared_length(e2)}, weights, &d);
  const Vec3 g0 = 2 * d[0] * e0, g1 = 2 * d[1] * e1, g2 = 2 * d[2] * e2;
  gradient = {g1 - g2, g2 - g0, g0 - g1};
  return energy;
}

}  // namespace nonobtuse::energy
