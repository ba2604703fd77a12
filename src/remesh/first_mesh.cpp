// Why so: the diagram is needed to spread the sites over the surface, which a quarter of them does
// as well. To bring their connectivity in order takes many more, and these a
// mesh of a few thousand vertices does at a tenth of the cost; subdivided, it has nearly regular
// connectivity, which a start from sites reaches late or never.
#include "remesh/first_mesh.h"

#include <cmath>
#include <utility>

#include "energy/mesh_shape.h"
#include "remesh/initial_sampling.h"
#include "remesh/localized_cvt.h"
#include "remesh/mesh_subdivision.h"
#include "remesh/restricted_diagram.h"

namespace nonobtuse::pipeline {
namespace {

constexpr Index kFewestVertices = 1000;
// Beyond this, tips and fingers are lost at a quarter of the vertices.
constexpr double kMostAreaRatio = 1.45;
// On the coarse mesh, where flips should be many, and on the fine one, where they should be few.
constexpr MeshDescentOptions kCoarse{.steps = 40, .steps_between_flips = 2, .circumcentre = 0};
constexpr MeshDescentOptions kFine{.steps = 25, .steps_between_flips = 5, .circumcentre = 1};

// Notes the CVT energy of the mesh and its bad triangles.
void record(const mesh::EditableMesh& mesh, int iteration, parallel::Monitor& monitor) {
  if (!monitor.recording()) return;
  double sum = 0;
  for (const Triangle& t : mesh.triangles())
    sum += energy::triangle_shape(
        energy::squared_edges(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]),
        {1, 0});
  const BadTriangles bad = count_bad_triangles(mesh.positions, mesh.triangles());
  monitor.record(iteration, sum, bad.obtuse, bad.small);
}

// Whether meshes alone will do: no boundary, no sizing, one component, enough vertices.
bool is_suited(const mesh::Surface& surface, const Components& components, Index vertices) {
  return surface.size.empty() && components.count() == 1 && !(components.boundary_length[0] > 0) &&
         vertices >= kFewestVertices;
}

void settle(const mesh::Surface& surface, MeshOnSurface& tessellation,
            const parallel::Workers& workers, parallel::Monitor& monitor) {
  int block = 0;
  minimize_on_mesh(surface, tessellation, kFine, workers, [&] {
    record(tessellation.mesh, kFine.steps_between_flips * block, monitor);
    ++block;
    return monitor.tick(1);
  });
}

}  // namespace

FirstMesh first_mesh(const mesh::Surface& surface, const CvtOptions& options,
                     const parallel::Workers& workers, parallel::Monitor& monitor) {
  FirstMesh result;
  const Index vertices = options.sites;
  const Components components = connected_components(surface);
  if (!is_suited(surface, components, vertices)) return result;
  // The midpoints of all edges will join them: V + E of a closed mesh is 4 V - 3 x.
  const auto coarse = static_cast<Index>(std::round((vertices + 3.0 * components.euler[0]) / 4));
  CvtOptions of_coarse = options;
  of_coarse.sites = coarse;
  of_coarse.iterations = options.coarse_iterations;
  of_coarse.tolerance = options.coarse_tolerance;
  of_coarse.recorded = false;
  result.coarse = optimize_level(surface, of_coarse, workers, monitor);
  if (monitor.cancelled()) return result;
  // The edges of a triangulation; what is none is seen at once and cheaply this way.
  if (std::ssize(result.coarse.adjacent) != 3 * (coarse - components.euler[0])) return result;
  SiteCells cells = site_cells(surface, result.coarse.sites, workers);
  if (!cells.defects.empty() || cells.localized.orphans > 0) return result;
  MeshOnSurface t{mesh::EditableMesh(result.coarse.sites, std::move(cells.triangles)),
                  std::move(cells.feet)};
  if (largest_area_ratio(surface, t, workers) > kMostAreaRatio) return result;
  minimize_on_mesh(surface, t, kCoarse, workers, [&] { return monitor.tick(1); });
  t = subdivided(surface, t, vertices);
  settle(surface, t, workers, monitor);
  if (unfold(surface, t) == 0 && t.mesh.vertex_count() == vertices)
    result.tessellation = std::move(t);
  return result;
}

}  // namespace nonobtuse::pipeline
