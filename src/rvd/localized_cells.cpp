// Yan, Bao, Zhang, Wonka, 2014.
#include "rvd/localized_cells.h"

#include <limits>
#include <numeric>

#include "spatial/closest_point.h"

namespace nonobtuse::rvd {

namespace {

// Disjoint sets whose roots are their least elements.
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Index root(Index a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace

CellComponents cell_components(const mesh::Surface& surface, const RestrictedVoronoi& diagram) {
  const Index facets = static_cast<Index>(surface.triangles.size());
  DisjointSets sets(diagram.piece_count());
  for (Index f = 0; f < facets; ++f)
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p)
      for (const Side s : diagram.sides_of(p))
        if (is_edge(s) && surface.adjacent[f][edge_of(s)] > f)
          sets.join(p, diagram.across(surface, f, p, edge_of(s)));
  CellComponents result;
  result.of_piece.resize(diagram.piece_count());
  for (Index p = 0; p < diagram.piece_count(); ++p) {
    const Index root = sets.root(p);
    if (root == p) {
      result.of_piece[p] = static_cast<Index>(result.site.size());
      result.site.push_back(diagram.site[p]);
    } else {
      result.of_piece[p] = result.of_piece[root];
    }
  }
  return result;
}

std::vector<Index> cell_feet(const mesh::Surface& surface, std::span<const Vec3> sites,
                             const RestrictedVoronoi& diagram) {
  std::vector<Index> feet(sites.size(), -1);
  std::vector<double> nearest(sites.size(), std::numeric_limits<double>::infinity());
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const Triangle& t = surface.triangles[f];
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const Index i = diagram.site[p];
      // The distance to the plane is a lower bound.
      const double height = dot(surface.normals[f], sites[i] - surface.vertices[t[0]]);
      if (height * height * (1 - 1e-12) >= nearest[i]) continue;
      const double d =
          spatial::closest_point_on_triangle(sites[i], surface.vertices[t[0]],
                                             surface.vertices[t[1]], surface.vertices[t[2]])
              .squared_distance;
      if (d < nearest[i]) {
        nearest[i] = d;
        feet[i] = f;
      }
    }
  }
  return feet;
}

}  // namespace nonobtuse::rvd
