// Edelsbrunner, Shah, 1997. Under the symbolic perturbation every point where cells meet inside a
// facet belongs to exactly three, so the dual has triangles only.
#include "rdt/restricted_delaunay.h"

namespace nonobtuse::rdt {

std::vector<Triangle> restricted_delaunay(const rvd::RestrictedVoronoi& diagram) {
  std::vector<Triangle> triangles;
  for (Index p = 0; p < diagram.piece_count(); ++p) {
    const auto sides = diagram.sides_of(p);
    const Index i = diagram.site[p];
    rvd::Side before = sides.back();
    for (const rvd::Side after : sides) {
      // Counter-clockwise around the corner lie the cells of i, before, after.
      if (before > i && after > i) triangles.push_back({i, before, after});
      before = after;
    }
  }
  return triangles;
}

}  // namespace nonobtuse::rdt
