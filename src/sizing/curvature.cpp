#include "sizing/curvature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace nonobtuse::sizing {
namespace {

// Upper triangle xx, xy, xz, yy, yz, zz.
using Tensor = std::array<double, 6>;

void add(Tensor& sum, double weight, const Vec3& e) {
  sum[0] += weight * e.x * e.x;
  sum[1] += weight * e.x * e.y;
  sum[2] += weight * e.x * e.z;
  sum[3] += weight * e.y * e.y;
  sum[4] += weight * e.y * e.z;
  sum[5] += weight * e.z * e.z;
}

// Half of what each edge of the facet bends: signed dihedral angle times length.
Tensor facet_tensor(const mesh::Surface& surface, Index f) {
  Tensor sum{};
  const Triangle& t = surface.triangles[f];
  for (int k = 0; k < 3; ++k) {
    const Index g = surface.adjacent[f][k];
    if (g < 0) continue;
    const Vec3 edge = surface.vertices[t[mesh::previous(k)]] - surface.vertices[t[mesh::next(k)]];
    const double l = length(edge);
    if (!(l > 0)) continue;
    const Vec3 direction = edge / l;
    const Vec3 turn = cross(surface.normals[f], surface.normals[g]);
    const double angle =
        std::atan2(dot(turn, direction), dot(surface.normals[f], surface.normals[g]));
    add(sum, 0.5 * angle * l, direction);
  }
  return sum;
}

double largest_eigenvalue(const Tensor& t) {
  Eigen::Matrix3d m;
  m << t[0], t[1], t[2], t[1], t[3], t[4], t[2], t[4], t[5];
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
  return std::max(std::abs(values[0]), std::abs(values[2]));
}

}  // namespace

std::vector<double> largest_curvature(const mesh::Surface& surface, double radius,
                                      const parallel::Workers& workers) {
  const std::size_t facets = surface.triangles.size();
  std::vector<Tensor> tensor(facets);
  std::vector<Vec3> center(facets);
  workers.for_each(facets, 1024, [&](std::size_t f) {
    tensor[f] = facet_tensor(surface, static_cast<Index>(f));
    const Triangle& t = surface.triangles[f];
    center[f] = (surface.vertices[t[0]] + surface.vertices[t[1]] + surface.vertices[t[2]]) / 3;
  });
  std::vector<Index> some_facet(surface.vertices.size(), -1);
  for (std::size_t f = facets; f-- > 0;)
    for (const Index v : surface.triangles[f]) some_facet[v] = static_cast<Index>(f);

  std::vector<double> curvature(surface.vertices.size(), 0);
  workers.for_chunks(curvature.size(), 8192, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Index> seen(facets, -1);
    std::vector<Index> disc;
    for (std::size_t v = begin; v < end; ++v) {
      if (some_facet[v] < 0) continue;
      const auto mark = static_cast<Index>(v);
      const auto in_disc = [&](Index f) {
        if (squared_distance(center[f], surface.vertices[v]) <= radius * radius) return true;
        const Triangle& t = surface.triangles[f];  // the ring belongs to it always
        return t[0] == mark || t[1] == mark || t[2] == mark;
      };
      disc.assign(1, some_facet[v]);
      seen[some_facet[v]] = mark;
      Tensor sum{};
      double area = 0;
      for (std::size_t k = 0; k < disc.size(); ++k) {
        area += surface.areas[disc[k]];
        for (int i = 0; i < 6; ++i) sum[i] += tensor[disc[k]][i];
        for (const Index g : surface.adjacent[disc[k]]) {
          if (g < 0 || seen[g] == mark || !in_disc(g)) continue;
          seen[g] = mark;
          disc.push_back(g);
        }
      }
      if (!(area > 0)) continue;
      for (double& s : sum) s /= area;
      curvature[v] = largest_eigenvalue(sum);
    }
  });
  return curvature;
}

}  // namespace nonobtuse::sizing
