// Yan, Bao, Zhang, Wonka, 2014.
#include "rvd/localized_cells.h"

#include <algorithm>
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

CellComponents cell_components(const mesh::Surface& surface, const RestrictedVoronoi& diagram,
                               std::span<const Index> owner) {
  const Index facets = static_cast<Index>(surface.triangles.size());
  DisjointSets sets(diagram.piece_count());
  const bool plain = owner.data() == diagram.site.data();
  for (Index f = 0; f < facets; ++f) {
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      for (const Side s : diagram.sides_of(p)) {
        if (is_edge(s)) {
          if (surface.adjacent[f][edge_of(s)] > f)
            sets.join(p, diagram.across(surface, f, p, edge_of(s)));
        } else if (!plain && s > diagram.site[p]) {
          const Index q = diagram.find(f, s);
          if (owner[q] == owner[p]) sets.join(p, q);
        }
      }
    }
  }
  CellComponents result;
  result.of_piece.resize(diagram.piece_count());
  for (Index p = 0; p < diagram.piece_count(); ++p) {
    const Index root = sets.root(p);
    if (root == p) {
      result.of_piece[p] = static_cast<Index>(result.owner.size());
      result.owner.push_back(owner[p]);
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

namespace {

double piece_area(const std::vector<Vec3>& corners) {
  double twice = 0;
  for (std::size_t m = 1; m + 1 < corners.size(); ++m)
    twice += length(area_vector(corners[0], corners[m], corners[m + 1]));
  return 0.5 * twice;
}

// The component that stays with each site, -1 for an empty cell.
std::vector<Index> home_components(const mesh::Surface& surface, std::span<const Vec3> sites,
                                   const RestrictedVoronoi& diagram, std::span<const Index> feet,
                                   const CellComponents& components) {
  std::vector<Index> home(sites.size(), -1);
  std::vector<char> needs_area(sites.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Index p = feet[i] < 0 ? -1 : diagram.find(feet[i], static_cast<Index>(i));
    if (p >= 0) {
      home[i] = components.of_piece[p];
    } else {
      needs_area[i] = 1;
      any = true;
    }
  }
  if (!any) return home;
  std::vector<double> area(components.owner.size(), 0);
  std::vector<Vec3> corners;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f)
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      if (!needs_area[diagram.site[p]]) continue;
      corner_positions(surface, sites, diagram, f, p, corners);
      area[components.of_piece[p]] += piece_area(corners);
    }
  for (Index c = 0; c < static_cast<Index>(components.owner.size()); ++c) {
    const Index i = components.owner[c];
    if (needs_area[i] && (home[i] < 0 || area[c] > area[home[i]])) home[i] = c;
  }
  return home;
}

// Length of the common boundary of an orphan component and another one.
struct Contact {
  Index orphan;
  Index other;
  double length;
};

std::vector<Contact> contacts_of_orphans(const mesh::Surface& surface, std::span<const Vec3> sites,
                                         const RestrictedVoronoi& diagram,
                                         const CellComponents& components,
                                         const std::vector<Index>& owner_of_component) {
  std::vector<Contact> all;
  std::vector<Vec3> corners;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f)
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const Index c = components.of_piece[p];
      if (owner_of_component[c] >= 0) continue;
      const auto sides = diagram.sides_of(p);
      corner_positions(surface, sites, diagram, f, p, corners);
      for (std::size_t m = 0; m < sides.size(); ++m)
        if (!is_edge(sides[m]))
          all.push_back({c, components.of_piece[diagram.find(f, sides[m])],
                         distance(corners[m], corners[(m + 1) % corners.size()])});
    }
  std::stable_sort(all.begin(), all.end(), [](const Contact& a, const Contact& b) {
    return a.orphan != b.orphan ? a.orphan < b.orphan : a.other < b.other;
  });
  std::vector<Contact> merged;
  for (const Contact& c : all) {
    if (merged.empty() || merged.back().orphan != c.orphan || merged.back().other != c.other)
      merged.push_back({c.orphan, c.other, 0});
    merged.back().length += c.length;
  }
  return merged;
}

}  // namespace

LocalizedCells localized_cells(const mesh::Surface& surface, std::span<const Vec3> sites,
                               const RestrictedVoronoi& diagram, std::span<const Index> feet) {
  const CellComponents components = cell_components(surface, diagram, diagram.site);
  const std::vector<Index> home = home_components(surface, sites, diagram, feet, components);
  const Index count = static_cast<Index>(components.owner.size());
  std::vector<Index> owner(count, -1);
  LocalizedCells result;
  for (Index c = 0; c < count; ++c)
    if (home[components.owner[c]] == c) {
      owner[c] = components.owner[c];
    } else {
      ++result.orphans;
    }
  if (result.orphans > 0) {
    std::vector<Contact> contacts = contacts_of_orphans(surface, sites, diagram, components, owner);
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const Contact& a, const Contact& b) { return a.length > b.length; });
    // Longest first, among those that touch a component already given away.
    for (bool changed = true; changed;) {
      changed = false;
      for (const Contact& c : contacts)
        if (owner[c.orphan] < 0 && owner[c.other] >= 0) {
          owner[c.orphan] = owner[c.other];
          changed = true;
        }
    }
    // A component of the surface without any site on it: keeps its Euclidean cells.
    for (Index c = 0; c < count; ++c)
      if (owner[c] < 0) owner[c] = components.owner[c];
  }
  result.owner.resize(diagram.piece_count());
  for (Index p = 0; p < diagram.piece_count(); ++p) result.owner[p] = owner[components.of_piece[p]];
  return result;
}

}  // namespace nonobtuse::rvd
