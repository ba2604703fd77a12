// Steps of the pipeline on their own, for research: the exact restricted Voronoi diagram and its
// dual, the CVT energy with its gradient.
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "bindings.h"
#include "energy/cvt.h"
#include "mesh/surface.h"
#include "nonobtuse/error.h"
#include "nonobtuse/options.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "quality/validity.h"
#include "rdt/restricted_delaunay.h"
#include "remesh/normalization.h"
#include "remesh/parts.h"
#include "rvd/candidate_lists.h"
#include "rvd/cell_integrals.h"
#include "rvd/localized_cells.h"
#include "rvd/restricted_voronoi.h"
#include "sizing/local_feature_size.h"

namespace nonobtuse::python {
namespace {

// A surface and sites on it, multiplied by a power of two: what the engines decide exactly of these
// doubles they decide of the given ones.
struct Problem {
  double scale = 1;
  mesh::Surface surface;
  std::vector<Vec3> sites;
};

// Throws InvalidInput for what the engines take for granted.
void require_surface(const TriangleMesh& input) {
  quality::require_measurable(input);
  if (input.triangles.empty()) throw InvalidInput("The mesh has no triangles.");
  const Topology topology = measure_topology(input);
  if (topology.nonmanifold_edges > 0 || !topology.oriented)
    throw InvalidInput(
        "The mesh must have at most two triangles at every edge, oriented alike; see "
        "nonobtuse.clean.");
}

Problem problem_of(const TriangleMesh& input, const std::vector<Vec3>& sites) {
  const Index count = static_cast<Index>(sites.size());
  if (count == 0) throw InvalidInput("There must be at least one site.");
  for (Index i = 0; i < count; ++i)
    if (!is_finite(sites[i]))
      throw InvalidInput("Site " + std::to_string(i) + " is not finite.", i);
  require_surface(input);
  Problem problem;
  problem.scale = std::min(quality::unit_scale(input), quality::unit_scale({sites, {}}));
  TriangleMesh scaled = quality::scaled(input, problem.scale);
  problem.surface = mesh::make_surface(std::move(scaled.vertices), std::move(scaled.triangles));
  if (!(problem.surface.area > 0)) throw InvalidInput("The mesh has no area.");
  problem.sites = quality::scaled({sites, {}}, problem.scale).vertices;
  return problem;
}

rvd::RestrictedVoronoi diagram_of(const Problem& problem, const parallel::Workers& workers) {
  return rvd::restricted_voronoi(problem.surface, problem.sites,
                                 rvd::facet_candidates(problem.surface, problem.sites, workers),
                                 workers);
}

std::vector<Index> owners(const Problem& problem, const rvd::RestrictedVoronoi& diagram,
                          bool localized) {
  if (!localized) return diagram.site;
  const std::vector<Index> feet = rvd::cell_feet(problem.surface, problem.sites, diagram);
  return rvd::localized_cells(problem.surface, problem.sites, diagram, feet).owner;
}

void divide(std::vector<Vec3>& points, double by) {
  for (Vec3& p : points) p = p / by;
}

struct Diagram {
  std::vector<Index> face, site, start, side;
  std::vector<Vec3> corners;
  std::vector<std::array<Index, 2>> edges;
  std::vector<double> lengths;
};

Diagram flat_diagram(const Problem& problem, rvd::RestrictedVoronoi&& diagram,
                     std::vector<Index>&& owner) {
  Diagram flat;
  flat.face.reserve(owner.size());
  std::vector<Vec3> corners;
  for (Index f = 0; f + 1 < static_cast<Index>(diagram.facet_start.size()); ++f)
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      flat.face.push_back(f);
      rvd::corner_positions(problem.surface, problem.sites, diagram, f, p, corners);
      flat.corners.insert(flat.corners.end(), corners.begin(), corners.end());
    }
  divide(flat.corners, problem.scale);
  for (const rvd::DualEdge& e : rvd::dual_edges(problem.surface, problem.sites, diagram)) {
    flat.edges.push_back({e.site, e.other});
    flat.lengths.push_back(e.length / problem.scale);
  }
  flat.site = std::move(owner);
  flat.start = std::move(diagram.side_start);
  flat.side = std::move(diagram.sides);
  return flat;
}

nb::tuple restricted_voronoi_arrays(const VertexArray& vertices, const FaceArray& faces,
                                    const VertexArray& sites, bool localized, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const std::vector<Vec3> points = rows_of<Vec3>(sites);
  Diagram flat;
  {
    const nb::gil_scoped_release release;
    const parallel::Workers workers(threads);
    const Problem problem = problem_of(mesh, points);
    rvd::RestrictedVoronoi diagram = diagram_of(problem, workers);
    std::vector<Index> owner = owners(problem, diagram, localized);
    flat = flat_diagram(problem, std::move(diagram), std::move(owner));
  }
  return nb::make_tuple(array_of(std::move(flat.face)), array_of(std::move(flat.site)),
                        array_of(std::move(flat.start)), array_of(std::move(flat.corners)),
                        array_of(std::move(flat.side)), array_of<Index>(std::move(flat.edges), 2),
                        array_of(std::move(flat.lengths)));
}

nb::object restricted_delaunay_arrays(const VertexArray& vertices, const FaceArray& faces,
                                      const VertexArray& sites, bool localized, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const std::vector<Vec3> points = rows_of<Vec3>(sites);
  std::vector<Triangle> dual;
  {
    const nb::gil_scoped_release release;
    const parallel::Workers workers(threads);
    const Problem problem = problem_of(mesh, points);
    const rvd::RestrictedVoronoi diagram = diagram_of(problem, workers);
    dual = rdt::restricted_delaunay(diagram, owners(problem, diagram, localized));
  }
  return array_of(std::move(dual));
}

nb::tuple cvt_energy_arrays(const VertexArray& vertices, const FaceArray& faces,
                            const VertexArray& sites, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const std::vector<Vec3> points = rows_of<Vec3>(sites);
  rvd::CellIntegrals cells;
  std::vector<Vec3> gradient(points.size());
  {
    const nb::gil_scoped_release release;
    const parallel::Workers workers(threads);
    const Problem problem = problem_of(mesh, points);
    const double s = problem.scale;
    rvd::CellEvaluator evaluator(problem.surface, static_cast<Index>(points.size()), workers);
    evaluator.evaluate(problem.sites, cells);
    energy::cvt_gradient(problem.sites, cells, gradient, workers);
    // The energy is a length to the fourth, its gradient one to the third.
    cells.energy = cells.energy / s / s / s / s;
    for (Vec3& g : gradient) g = g / s / s / s;
    for (double& m : cells.mass) m = m / s / s;
    divide(cells.centroid, s);
  }
  return nb::make_tuple(cells.energy, array_of(std::move(gradient)),
                        array_of(std::move(cells.mass)), array_of(std::move(cells.centroid)));
}

nb::object local_feature_size_array(const VertexArray& vertices, const FaceArray& faces,
                                    Index samples, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  std::vector<double> sizes;
  {
    const nb::gil_scoped_release release;
    require_surface(mesh);
    const parallel::Workers workers(threads);
    const pipeline::NormalizedInput input = pipeline::normalize(mesh, samples);
    sizes = sizing::local_feature_size(input.surface, samples, workers);
    for (double& s : sizes) s = s / input.map.scale;
  }
  return array_of(std::move(sizes));
}

// Pairs of vertices, the lower first, sorted. Empty `angle`: as Features::Auto does it.
std::vector<std::array<Index, 2>> feature_edges_of(const TriangleMesh& mesh,
                                                   std::optional<double> angle) {
  RemeshOptions options;
  options.features = angle ? Features::Dihedral : Features::Auto;
  options.feature_angle = angle.value_or(options.feature_angle);
  std::vector<pipeline::Part> parts = pipeline::connected_parts(mesh);
  pipeline::find_features(mesh, options, parts);
  std::vector<std::array<Index, 2>> edges;
  for (const pipeline::Part& part : parts)
    for (std::size_t f = 0; f < part.features.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        if (!features::flagged(part.features, static_cast<Index>(f), k)) continue;
        const Triangle& t = mesh.triangles[part.facet[f]];
        const auto [low, high] = std::minmax(t[mesh::next(k)], t[mesh::previous(k)]);
        edges.push_back({low, high});
      }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

nb::object detect_features_array(const VertexArray& vertices, const FaceArray& faces,
                                 std::optional<double> angle) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  std::vector<std::array<Index, 2>> edges;
  {
    const nb::gil_scoped_release release;
    require_surface(mesh);
    edges = feature_edges_of(mesh, angle);
  }
  return array_of<Index>(std::move(edges), 2);
}

}  // namespace

void bind_stages(nb::module_& module) {
  module.def("restricted_voronoi", restricted_voronoi_arrays);
  module.def("restricted_delaunay", restricted_delaunay_arrays);
  module.def("cvt_energy", cvt_energy_arrays);
  module.def("local_feature_size", local_feature_size_array);
  module.def("detect_features", detect_features_array, nb::arg(), nb::arg(), nb::arg().none());
}

}  // namespace nonobtuse::python
