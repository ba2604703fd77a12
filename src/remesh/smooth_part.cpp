// Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG 2016, section 4.2;
// the obtuse removal is replaced by refinement on the mesh (docs/pipeline.md).
#include "remesh/smooth_part.h"

#include <utility>
#include <vector>

#include "parallel/monitor.h"
#include "remesh/cvt_optimization.h"
#include "remesh/dislocation_annealing.h"
#include "remesh/extraction.h"
#include "remesh/first_mesh.h"
#include "remesh/paper_method.h"
#include "remesh/refinement.h"
#include "remesh/request.h"
#include "remesh/valence_optimization.h"

namespace nonobtuse::pipeline {
namespace {

// The paper's own stages after plain CVT.
std::vector<Vec3> paper_stages(const mesh::Surface& surface, std::vector<Vec3> sites,
                               const RemeshOptions& options, const parallel::Workers& workers,
                               StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  const bool feature_sensitive =
      (options.method == Method::CvtFs || options.method == Method::CvtNob) &&
      options.normal_weight > 1;
  const double penalty = options.method == Method::CvtNob ? options.penalty : 0;
  const int iterations = paper_iterations(options);
  if (options.method == Method::CvtNob)
    sites = clock.run("obtuse removal", 0.1, 0.25, [&] {
      return optimize_paper_nob(
          surface, std::move(sites),
          {.weights = {.short_dual = penalty}, .seed = options.seed, .iterations = iterations},
          workers, monitor);
    });
  if (feature_sensitive)
    sites = clock.run("feature-sensitive", 0.25, 0.4, [&] {
      return optimize_feature_sensitive(
          surface, std::move(sites),
          {.normal_weight = options.normal_weight, .short_dual = penalty}, iterations, workers,
          monitor);
    });
  return sites;
}

}  // namespace

StartingMesh starting_mesh(const mesh::Surface& surface, Index n, const RemeshOptions& options,
                           const parallel::Workers& workers, StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  FirstMesh first;
  std::vector<Vec3> sites = clock.run("cvt", 0, 0.4, [&] {
    CvtOptions cvt = cvt_options(options, n);
    if (options.method == Method::Default) first = first_mesh(surface, cvt, workers, monitor);
    if (first.tessellation.mesh.vertex_count() > 0) return std::vector<Vec3>{};
    cvt.start = std::move(first.coarse);
    return optimize_cvt(surface, cvt, workers, monitor);
  });
  if (sites.empty()) return {std::move(first.tessellation), true};
  sites = paper_stages(surface, std::move(sites), options, workers, clock);
  Extraction extraction = clock.run(
      "extraction", 0.4, 0.5, [&] { return extract(surface, std::move(sites), workers, monitor); });
  return {{std::move(extraction.mesh), std::move(extraction.foot)}, false};
}

mesh::EditableMesh remesh_smooth(const mesh::Surface& surface, spatial::TriangleBvh& bvh, Index n,
                                 const RemeshOptions& options, const parallel::Workers& workers,
                                 StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  StartingMesh start = starting_mesh(surface, n, options, workers, clock);
  mesh::EditableMesh& mesh = start.tessellation.mesh;
  // Not earlier: the tessellation takes most of the memory.
  bvh = spatial::TriangleBvh(surface.vertices, surface.triangles, workers);
  // After a cancellation what there is goes out at once.
  if (options.method != Method::Default || monitor.cancelled()) return std::move(mesh);
  clock.run("valence", 0.5, 0.55, [&] {
    if (is_coarse(surface, start.tessellation))
      anneal_dislocations(surface, start.tessellation, options.seed,
                          [&](double f) { return monitor.tick(0.5 * f); });
    return optimize_valence(surface, bvh, mesh, workers, monitor);
  });
  clock.run("refinement", 0.55, 1, [&] {
    RefinementOptions refinement = refinement_options(options);
    refinement.settled = start.settled;
    return refine(surface, bvh, mesh, refinement, workers, monitor);
  });
  return std::move(mesh);
}

}  // namespace nonobtuse::pipeline
