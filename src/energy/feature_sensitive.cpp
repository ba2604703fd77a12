#include "energy/feature_sensitive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "energy/cvt.h"

namespace nonobtuse::energy {

namespace {

// The density on the plane of one facet, linear.
class FacetDensity {
 public:
  FacetDensity(const mesh::Surface& surface, Index facet) {
    const Triangle& t = surface.triangles[facet];
    origin_ = surface.vertices[t[0]];
    if (surface.size.empty() || !(surface.areas[facet] > 0)) return;
    std::array<double, 3> rho{};
    for (int k = 0; k < 3; ++k) {
      const double size = surface.size[t[k]];
      rho[k] = 1 / (size * size * size * size);
    }
    at_origin_ = rho[0];
    // The gradient of barycentric coordinate k: the opposite edge, turned inwards, over 2 area.
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = surface.vertices[t[mesh::previous(k)]] - surface.vertices[t[mesh::next(k)]];
      slope_ += rho[k] / (2 * surface.areas[facet]) * cross(surface.normals[facet], edge);
    }
  }

  [[nodiscard]] double at(const Vec3& x) const {
    return std::max(0.0, at_origin_ + dot(slope_, x - origin_));
  }

 private:
  Vec3 origin_;
  Vec3 slope_;
  double at_origin_ = 1;
};

// Mass and Eq. 1 of one piece: a fan of triangles.
struct PieceSums {
  double mass = 0;
  PieceEnergy cvt;
};

PieceSums integrate_piece(const std::vector<Vec3>& corners, const std::vector<double>& rho,
                          const Vec3& site) {
  PieceSums sums;
  for (std::size_t m = 1; m + 1 < corners.size(); ++m) {
    const std::array<Vec3, 3> p{corners[0], corners[m], corners[m + 1]};
    const std::array<double, 3> r{rho[0], rho[m], rho[m + 1]};
    const double area = 0.5 * length(area_vector(p[0], p[1], p[2]));
    sums.mass += area * (r[0] + r[1] + r[2]) / 3;
    const PieceEnergy part = cvt_piece(p, r, site);
    sums.cvt.energy += part.energy;
    sums.cvt.gradient += part.gradient;
  }
  return sums;
}

// Gradient of the site at the left of the border from a to b, whose densities are ra and rb;
// `jump` = (s^2 - 1) (h_i^2 - h_j^2) |b - a| / |P (x_j - x_i)|.
Vec3 border_gradient(const Vec3& site, const Vec3& a, const Vec3& b, double ra, double rb,
                     double jump) {
  return jump / 6 * ((2 * ra + rb) * (a - site) + (ra + 2 * rb) * (b - site));
}

}  // namespace

double add_feature_sensitive(const mesh::Surface& surface, std::span<const Vec3> sites,
                             const rvd::RestrictedVoronoi& diagram, double normal_weight,
                             std::span<Vec3> gradient,
                             std::span<numeric::SymmetricMatrix> hessian) {
  const double extra = normal_weight * normal_weight - 1;
  double energy = 0;
  std::vector<Vec3> corners;
  std::vector<double> rho;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const FacetDensity density(surface, f);
    const Vec3& normal = surface.normals[f];
    const Vec3& on_facet = surface.vertices[surface.triangles[f][0]];
    const auto height = [&](Index i) { return dot(normal, on_facet - sites[i]); };
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const Index i = diagram.site[p];
      rvd::corner_positions(surface, sites, diagram, f, p, corners);
      rho.clear();
      for (const Vec3& c : corners) rho.push_back(density.at(c));
      const PieceSums piece = integrate_piece(corners, rho, sites[i]);
      const double h = height(i);
      energy += piece.cvt.energy + extra * h * h * piece.mass;
      gradient[i] += piece.cvt.gradient - 2 * extra * h * piece.mass * normal;
      hessian[i].add_identity(2 * piece.mass);
      hessian[i].add_outer(2 * extra * piece.mass, normal);
      if (extra == 0) continue;
      // Borders from this side; the neighbour adds its own part on its own turn.
      const std::span<const rvd::Side> sides = diagram.sides_of(p);
      for (std::size_t m = 0; m < sides.size(); ++m) {
        if (rvd::is_edge(sides[m])) continue;
        const Index j = sides[m];
        const Vec3 across = sites[j] - sites[i];
        const double in_plane = length(across - dot(across, normal) * normal);
        if (!(in_plane > 1e-12 * length(across))) continue;  // a border parallel to the facet
        const std::size_t next = (m + 1) % sides.size();
        const double hj = height(j);
        const double jump =
            extra * (h * h - hj * hj) * distance(corners[m], corners[next]) / in_plane;
        gradient[i] +=
            border_gradient(sites[i], corners[m], corners[next], rho[m], rho[next], jump);
      }
    }
  }
  return energy;
}

}  // namespace nonobtuse::energy
