// The figures together. Distances are taken in coordinates scaled by a power of two, so that
// squares neither over- nor underflow.
#include <algorithm>
#include <cmath>
#include <vector>

#include "nonobtuse/error.h"
#include "nonobtuse/quality.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "quality/distance.h"
#include "quality/validity.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse {

namespace {

// A mesh and its reference on a common scale, ready to be searched.
struct Comparison {
  Comparison(const TriangleMesh& given, const TriangleMesh& given_reference,
             const parallel::Workers& workers)
      : scale(std::min(quality::unit_scale(given), quality::unit_scale(given_reference))),
        mesh(quality::scaled(given, scale)),
        reference(quality::scaled(given_reference, scale)),
        mesh_bvh(mesh.vertices, mesh.triangles, workers),
        reference_bvh(reference.vertices, reference.triangles, workers) {}

  double scale;
  TriangleMesh mesh;
  TriangleMesh reference;
  spatial::TriangleBvh mesh_bvh;
  spatial::TriangleBvh reference_bvh;
};

void require_comparable(const TriangleMesh& mesh, const TriangleMesh& reference) {
  quality::require_measurable(mesh);
  quality::require_measurable(reference);
  if (mesh.triangles.empty() || reference.triangles.empty())
    throw InvalidInput("There is no distance between two meshes of which one has no triangles.");
}

double diagonal_of(const TriangleMesh& mesh) {
  spatial::Box box;
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) box.add(mesh.vertices[v]);
  return distance(box.low, box.high);
}

SurfaceDistance distance_of(const Comparison& c, const parallel::Workers& workers) {
  const std::size_t samples = quality::default_samples(c.mesh, c.reference);
  const auto to =
      quality::one_sided_distance(c.mesh, c.mesh_bvh.order(), c.reference_bvh, samples, workers);
  const auto from = quality::one_sided_distance(c.reference, c.reference_bvh.order(), c.mesh_bvh,
                                                samples, workers);
  SurfaceDistance result;
  result.diagonal = diagonal_of(c.reference) / c.scale;
  result.hausdorff_to_reference = to.max / c.scale;
  result.hausdorff_from_reference = from.max / c.scale;
  result.rms_to_reference = to.rms / c.scale;
  result.rms_from_reference = from.rms / c.scale;
  result.hausdorff = std::max(result.hausdorff_to_reference, result.hausdorff_from_reference);
  result.rms = std::max(result.rms_to_reference, result.rms_from_reference);
  return result;
}

}  // namespace

SurfaceDistance measure_distance(const TriangleMesh& mesh, const TriangleMesh& reference,
                                 const Context& context) {
  require_comparable(mesh, reference);
  const parallel::Workers workers(context.threads);
  return distance_of(Comparison(mesh, reference, workers), workers);
}

std::vector<double> vertex_distances(const TriangleMesh& mesh, const TriangleMesh& reference,
                                     const Context& context) {
  require_comparable(mesh, reference);
  const parallel::Workers workers(context.threads);
  const double scale = std::min(quality::unit_scale(mesh), quality::unit_scale(reference));
  const TriangleMesh target = quality::scaled(reference, scale);
  const spatial::TriangleBvh bvh(target.vertices, target.triangles, workers);
  std::vector<double> distances(mesh.vertices.size());
  workers.for_each(distances.size(), 256, [&](std::size_t v) {
    distances[v] = std::sqrt(bvh.closest(scale * mesh.vertices[v]).squared_distance) / scale;
  });
  return distances;
}

QualityReport measure(const TriangleMesh& mesh, const TriangleMesh* reference,
                      const Context& context) {
  QualityReport report;
  report.angles = measure_angles(mesh);
  report.topology = measure_topology(mesh);
  report.self_intersections = count_self_intersections(mesh, context);
  if (reference != nullptr) {
    require_comparable(mesh, *reference);
    const parallel::Workers workers(context.threads);
    const Comparison c(mesh, *reference, workers);
    report.distance = distance_of(c, workers);
    report.flipped = quality::count_flipped(c.mesh, c.reference, c.reference_bvh, workers);
  }
  return report;
}

}  // namespace nonobtuse
