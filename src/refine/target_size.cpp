// In units of the target area a, the CVT energy of an equilateral triangle of area A is c (A/a)^2.
// Summed over a mesh of fixed total area, frozen targets and this weight would be in balance for A
// in proportion to a^2, not a; the linear term -2 c (1/2) (A/a) moves the balance of each triangle
// to A = a/2, its share. It is constant in sum where all targets are equal.
#include "refine/target_size.h"

#include <cmath>

namespace nonobtuse::refine {
namespace {

constexpr int kPasses = 3;
// c = (cot 60 / 2 + cot^3 60 / 6) 3/16 * 16/3, from the energy of an equilateral triangle.
constexpr double kEquilateral = 0.32075014954979206;

}  // namespace

void TargetSize::measure(const mesh::EditableMesh& mesh) {
  const Index count = mesh.vertex_capacity();
  std::vector<double> area(count, 0), sum(count), weight(count, 0);
  for (const Triangle& t : mesh.triangles()) {
    if (t[0] < 0) continue;
    const double a =
        length(area_vector(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
    for (const Index v : t) area[v] += a, weight[v] += 1;
  }
  // Twice the mean triangle around a vertex: right at boundaries and for any valence.
  for (Index v = 0; v < count; ++v) area[v] = weight[v] > 0 ? area[v] / weight[v] : 1;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (Index v = 0; v < count; ++v) sum[v] = weight[v] * area[v];
    for (const Triangle& t : mesh.triangles()) {
      if (t[0] < 0) continue;
      for (int k = 0; k < 3; ++k)
        sum[t[k]] += 0.5 * (area[t[mesh::next(k)]] + area[t[mesh::previous(k)]]);
    }
    for (Index v = 0; v < count; ++v)
      if (weight[v] > 0) area[v] = sum[v] / (2 * weight[v]);
  }
  of_vertex.resize(count);
  for (Index v = 0; v < count; ++v) of_vertex[v] = std::sqrt(std::max(area[v], 1e-12));
}

double TargetSize::shape(const Triangle& t, const std::array<Vec3, 3>& p,
                         const energy::ShapeWeights& weights) const {
  std::array<double, 3> s = energy::squared_edges(p[0], p[1], p[2]);
  if (uniform()) return energy::triangle_shape(s, weights);
  const double a = area(t);
  for (double& squared : s) squared /= a;
  return energy::triangle_shape(s, weights) -
         weights.cvt * kEquilateral * 0.5 * length(area_vector(p[0], p[1], p[2])) / a;
}

double TargetSize::shape(const Triangle& t, const std::array<Vec3, 3>& p,
                         const energy::ShapeWeights& weights, std::array<Vec3, 3>& gradient) const {
  if (uniform()) return energy::triangle_shape(p[0], p[1], p[2], weights, gradient);
  const double a = area(t);
  const double inverse = 1 / std::sqrt(a);
  double energy =
      energy::triangle_shape(inverse * p[0], inverse * p[1], inverse * p[2], weights, gradient);
  const Vec3 normal = area_vector(p[0], p[1], p[2]);
  const double twice = length(normal);
  energy -= weights.cvt * kEquilateral * 0.5 * twice / a;
  for (int k = 0; k < 3; ++k) {
    gradient[k] *= inverse;
    if (twice > 0)  // the area's derivative: half the opposite edge, turned inwards
      gradient[k] -= weights.cvt * kEquilateral * 0.5 / a / twice *
                     cross(normal, p[mesh::previous(k)] - p[mesh::next(k)]);
  }
  return energy;
}

}  // namespace nonobtuse::refine
