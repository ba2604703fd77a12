#include "remesh/penalized_energy.h"

#include <cmath>

#include "energy/feature_sensitive.h"
#include "energy/short_dual_penalty.h"
#include "energy/triangle_penalties.h"
#include "numeric/vec3.h"

namespace nonobtuse::pipeline {

namespace {

std::vector<Index> blocked_sites(const RestrictedDiagram& diagram) {
  if (diagram.defects.empty()) return {};
  std::vector<bool> defective(diagram.cells.mass.size(), false);
  for (const rdt::DefectiveCell& d : diagram.defects) defective[d.site] = true;
  std::vector<Index> blocked;
  for (const rdt::DefectiveCell& d : diagram.defects) blocked.push_back(d.site);
  for (const rvd::DualEdge& e : diagram.edges) {
    if (defective[e.site]) blocked.push_back(e.other);
    if (defective[e.other]) blocked.push_back(e.site);
  }
  return blocked;
}

// Mean of size^-2 over a cell: 1 if uniform.
double mean_inverse_square_size(const rvd::CellSums& cells, std::size_t i) {
  if (cells.sites.empty() || !(cells.sites[i] > 0)) return 1;
  return cells.mass[i] / cells.sites[i];
}

std::vector<double> cell_areas(const rvd::CellSums& cells) {
  std::vector<double> areas = cells.mass;
  for (std::size_t i = 0; i < cells.sites.size(); ++i)
    areas[i] = cells.sites[i] / mean_inverse_square_size(cells, i);
  return areas;
}

}  // namespace

Evaluation PenalizedEnergy::evaluate(const PlacedSites& x) {
  const RestrictedDiagram diagram = restricted_diagram(surface_, x.sites, workers_);
  const std::size_t n = x.sites.size();
  if (hinge_scale_ < 0) hinge_scale_ = 6.23 * diagram.cells.energy / static_cast<double>(n);
  Evaluation result;
  result.gradient.resize(n);
  result.hessian.resize(n);
  result.cell_area = cell_areas(diagram.cells);
  result.blocked = blocked_sites(diagram);
  add_cells(x, diagram, result);
  add_penalties(x, diagram, result);
  for (std::size_t i = 0; i < n; ++i)
    result.gradient[i] -= dot(result.gradient[i], x.normals[i]) * x.normals[i];
  const BadTriangles bad = count_bad_triangles(x.sites, diagram.triangles);
  result.score.defects = diagram.defects.size();
  result.score.obtuse = bad.obtuse;
  result.score.small = bad.small;
  return result;
}

void PenalizedEnergy::add_cells(const PlacedSites& x, const RestrictedDiagram& diagram,
                                Evaluation& result) const {
  if (weights_.normal_weight != 1) {
    result.score.energy =
        energy::add_feature_sensitive(surface_, x.sites, diagram.voronoi, weights_.normal_weight,
                                      result.gradient, result.hessian);
    return;
  }
  const rvd::CellSums& cells = diagram.cells;
  result.score.energy = cells.energy;
  for (std::size_t i = 0; i < x.sites.size(); ++i) {
    result.gradient[i] = 2 * cells.mass[i] * (x.sites[i] - cells.centroid[i]);
    result.hessian[i].add_identity(2 * cells.mass[i]);
  }
}

void PenalizedEnergy::add_penalties(const PlacedSites& x, const RestrictedDiagram& diagram,
                                    Evaluation& result) const {
  const std::size_t n = x.sites.size();
  const double unit = surface_.area / static_cast<double>(n);
  std::vector<double> diagonal(n, 0);
  if (weights_.short_dual > 0) {
    const std::vector<double> w =
        energy::short_dual_weights(x.sites, diagram.edges, weights_.relative_epsilon);
    std::vector<double> scale(n);  // frozen like w
    for (std::size_t i = 0; i < n; ++i)
      scale[i] = weights_.short_dual * unit * mean_inverse_square_size(diagram.cells, i);
    std::span<const Vec3> normals;
    if (weights_.tangential) normals = x.normals;
    result.score.energy += energy::add_short_dual_penalty(x.sites, diagram.edges, w, normals, scale,
                                                          result.gradient, diagonal);
  }
  if (weights_.circumcentre > 0 || weights_.hinge > 0) {
    const energy::ShapeWeights shape{0, weights_.circumcentre * unit, weights_.hinge * hinge_scale_,
                                     energy::cos_degrees(weights_.hinge_large),
                                     energy::cos_degrees(weights_.hinge_small)};
    result.score.energy += energy::add_triangle_penalties(x.sites, diagram.triangles, shape,
                                                          result.gradient, diagonal);
  }
  for (std::size_t i = 0; i < n; ++i) result.hessian[i].add_identity(diagonal[i]);
}

}  // namespace nonobtuse::pipeline
