// Edelsbrunner, Shah, 1997. Under the symbolic perturbation every point where cells meet inside a
// facet belongs to exactly three, so the dual has triangles only.
#include "rdt/restricted_delaunay.h"

#include <algorithm>

namespace nonobtuse::rdt {

std::vector<Triangle> restricted_delaunay(const rvd::RestrictedVoronoi& diagram,
                                          std::span<const Index> owner) {
  std::vector<Triangle> triangles;
  const bool plain = owner.data() == diagram.site.data();
  const Index facets = static_cast<Index>(diagram.facet_start.size()) - 1;
  for (Index f = 0; f < facets; ++f) {
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const auto sides = diagram.sides_of(p);
      const Index i = diagram.site[p];
      rvd::Side before = sides.back();
      for (const rvd::Side after : sides) {
        if (before > i && after > i) {  // each corner once, from its lowest site
          // Counter-clockwise around the corner lie the cells of i, before, after.
          Triangle t{i, before, after};
          if (!plain) t = {owner[p], owner[diagram.find(f, before)], owner[diagram.find(f, after)]};
          std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
          if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
        }
        before = after;
      }
    }
  }
  return triangles;
}

}  // namespace nonobtuse::rdt
