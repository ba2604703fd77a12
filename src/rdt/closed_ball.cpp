// Edelsbrunner, Shah, 1997. Cells are cell complexes with exact combinatorics, so connectedness
// and Euler characteristic decide which are discs: a connected surface with boundary of
// characteristic 1 is one.
#include "rdt/closed_ball.h"

#include <algorithm>
#include <utility>

#include "rvd/localized_cells.h"

namespace nonobtuse::rdt {

namespace {

using rvd::edge_of;
using rvd::is_edge;
using rvd::RestrictedVoronoi;
using rvd::Side;

// What is counted of a cell. Its vertices, edges and faces are seen from several pieces; each piece
// adds its share, in twelfths.
constexpr int kWhole = 12;
struct CellCounts {
  std::vector<int> euler;          // vertices - edges + faces of the closure
  std::vector<int> boundary_ends;  // ends of the arcs in which the cell meets the boundary
};

// Adds up the cells' counts piece by piece.
class CellCounter {
 public:
  CellCounter(const mesh::Surface& surface, const RestrictedVoronoi& diagram,
              std::span<const Index> owner, Index site_count)
      : surface_(surface),
        diagram_(diagram),
        owner_(owner),
        plain_(owner.data() == diagram.site.data()),
        seen_(surface.vertices.size(), 0),
        counts_{std::vector<int>(site_count, 0), std::vector<int>(site_count, 0)} {}

  CellCounts run() {
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f)
      for (Index p = diagram_.facet_start[f]; p < diagram_.facet_start[f + 1]; ++p) {
        const auto sides = diagram_.sides_of(p);
        int sum = kWhole;
        Side before = sides.back();
        for (const Side after : sides) {
          sum += corner(f, p, before, after) - side(f, p, after);
          before = after;
        }
        counts_.euler[owner_[p]] += sum;
      }
    return std::move(counts_);
  }

 private:
  [[nodiscard]] bool at_boundary(Index f, Side s) const {
    return surface_.adjacent[f][edge_of(s)] < 0;
  }
  // Whether the piece across a bisector belongs to the same cell.
  [[nodiscard]] bool same(Index f, Index p, Side s) const {
    return !plain_ && owner_[diagram_.find(f, s)] == owner_[p];
  }

  [[nodiscard]] int side(Index f, Index p, Side s) const {
    const bool alone = is_edge(s) ? at_boundary(f, s) : !same(f, p, s);
    return alone ? kWhole : kWhole / 2;
  }

  int corner(Index f, Index p, Side before, Side after) {
    if (is_edge(before) && is_edge(after)) {
      const Index v = surface_.triangles[f][3 - edge_of(before) - edge_of(after)];
      return std::exchange(seen_[v], 1) ? 0 : kWhole;
    }
    if (is_edge(before) || is_edge(after)) {
      const bool end = at_boundary(f, is_edge(before) ? before : after);
      const bool inner = same(f, p, is_edge(before) ? after : before);
      if (end && !inner) ++counts_.boundary_ends[owner_[p]];
      return kWhole / ((end ? 1 : 2) * (inner ? 2 : 1));
    }
    return kWhole / (1 + (same(f, p, before) ? 1 : 0) + (same(f, p, after) ? 1 : 0));
  }

  const mesh::Surface& surface_;
  const RestrictedVoronoi& diagram_;
  std::span<const Index> owner_;
  bool plain_;  // owners are the sites themselves: two pieces of one facet never share theirs
  std::vector<char> seen_;
  CellCounts counts_;
};

// Number of connected parts of every cell: pieces of one owner joined through facet edges, and
// inside a facet through bisectors.
std::vector<int> part_counts(const mesh::Surface& surface, const RestrictedVoronoi& diagram,
                             std::span<const Index> owner, Index site_count) {
  const rvd::CellComponents parts = rvd::cell_components(surface, diagram, owner);
  std::vector<int> count(site_count, 0);
  for (const Index i : parts.owner) ++count[i];
  return count;
}

// Arcs a -> b of the links of all vertices, grouped by vertex.
struct Links {
  std::vector<Index> start;
  std::vector<std::pair<Index, Index>> arcs;
};

Links vertex_links(const std::vector<Triangle>& triangles, Index count) {
  Links links{std::vector<Index>(count + 1, 0), {}};
  for (const Triangle& t : triangles)
    for (const Index v : t) ++links.start[v + 1];
  for (Index v = 0; v < count; ++v) links.start[v + 1] += links.start[v];
  links.arcs.resize(3 * triangles.size());
  std::vector<Index> fill(links.start.begin(), links.start.end() - 1);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) links.arcs[fill[t[k]]++] = {t[mesh::next(k)], t[mesh::previous(k)]};
  return links;
}

// Whether the arcs form one simple cycle (of at least three) or, at the boundary, one simple path.
bool is_proper_link(std::span<std::pair<Index, Index>> arcs, bool boundary) {
  if (arcs.size() < (boundary ? 1U : 3U)) return false;
  // Chain them up in place; links are short.
  if (boundary) {
    const auto has_predecessor = [&](Index a) {
      return std::any_of(arcs.begin(), arcs.end(),
                         [&](const auto& arc) { return arc.second == a; });
    };
    const auto first = std::find_if(arcs.begin(), arcs.end(),
                                    [&](const auto& arc) { return !has_predecessor(arc.first); });
    if (first == arcs.end()) return false;
    std::swap(*first, arcs[0]);
  }
  for (std::size_t m = 1; m < arcs.size(); ++m) {
    const auto following = std::find_if(arcs.begin() + m, arcs.end(), [&](const auto& arc) {
      return arc.first == arcs[m - 1].second;
    });
    if (following == arcs.end()) return false;
    std::swap(*following, arcs[m]);
  }
  const bool closed = arcs.back().second == arcs.front().first;
  if (closed == boundary) return false;
  // Chained, so the first ends are all the vertices of the link but the last of a path.
  for (std::size_t m = 0; m < arcs.size(); ++m) {
    if (boundary && arcs[m].first == arcs.back().second) return false;
    for (std::size_t l = 0; l < m; ++l)
      if (arcs[l].first == arcs[m].first) return false;
  }
  return true;
}

}  // namespace

std::vector<DefectiveCell> closed_ball_defects(const mesh::Surface& surface,
                                               const RestrictedVoronoi& diagram,
                                               std::span<const Index> owner, Index site_count,
                                               const std::vector<Triangle>& triangles) {
  const std::vector<int> parts = part_counts(surface, diagram, owner, site_count);
  const CellCounts counts = CellCounter(surface, diagram, owner, site_count).run();
  Links links = vertex_links(triangles, site_count);
  std::vector<DefectiveCell> defects;
  for (Index i = 0; i < site_count; ++i) {
    const std::span<std::pair<Index, Index>> arcs{links.arcs.data() + links.start[i],
                                                  links.arcs.data() + links.start[i + 1]};
    const int ends = counts.boundary_ends[i];
    if (parts[i] == 0) {
      defects.push_back({i, CellDefect::Empty});
    } else if (parts[i] > 1) {
      defects.push_back({i, CellDefect::Pieces});
    } else if (counts.euler[i] != kWhole) {
      defects.push_back({i, CellDefect::Handle});
    } else if (ends > 2 || !is_proper_link(arcs, ends == 2)) {
      defects.push_back({i, CellDefect::DoubleEdge});
    }
  }
  return defects;
}

}  // namespace nonobtuse::rdt
