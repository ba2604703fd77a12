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

// Twice vertices - edges + faces of the closure of every cell, and the ends of the arcs in which it
// meets the boundary. What two pieces share counts half in each.
struct CellCounts {
  std::vector<int> twice_euler;
  std::vector<int> boundary_ends;
};

CellCounts count_cells(const mesh::Surface& surface, const RestrictedVoronoi& diagram,
                       Index site_count) {
  CellCounts counts{std::vector<int>(site_count, 0), std::vector<int>(site_count, 0)};
  std::vector<char> seen(surface.vertices.size(), 0);
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const auto at_boundary = [&](Side s) { return surface.adjacent[f][edge_of(s)] < 0; };
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const Index i = diagram.site[p];
      int twice = 2;
      const auto sides = diagram.sides_of(p);
      Side before = sides.back();
      for (const Side after : sides) {
        twice -= is_edge(after) && !at_boundary(after) ? 1 : 2;
        if (is_edge(before) && is_edge(after)) {
          const Index v = surface.triangles[f][3 - edge_of(before) - edge_of(after)];
          if (!seen[v]) twice += 2;
          seen[v] = 1;
        } else if (is_edge(before) || is_edge(after)) {
          const bool end = at_boundary(is_edge(before) ? before : after);
          twice += end ? 2 : 1;
          counts.boundary_ends[i] += end ? 1 : 0;
        } else {
          twice += 2;
        }
        before = after;
      }
      counts.twice_euler[i] += twice;
    }
  }
  return counts;
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
  std::vector<Index> ends;
  for (const auto& arc : arcs) ends.push_back(arc.first);
  if (boundary) ends.push_back(arcs.back().second);
  std::sort(ends.begin(), ends.end());
  return std::adjacent_find(ends.begin(), ends.end()) == ends.end();
}

}  // namespace

std::vector<DefectiveCell> closed_ball_defects(const mesh::Surface& surface,
                                               const RestrictedVoronoi& diagram, Index site_count,
                                               const std::vector<Triangle>& triangles) {
  const rvd::CellComponents components = rvd::cell_components(surface, diagram);
  std::vector<int> component_count(site_count, 0);
  for (const Index i : components.site) ++component_count[i];
  const CellCounts counts = count_cells(surface, diagram, site_count);
  Links links = vertex_links(triangles, site_count);
  std::vector<DefectiveCell> defects;
  for (Index i = 0; i < site_count; ++i) {
    const std::span<std::pair<Index, Index>> arcs{links.arcs.data() + links.start[i],
                                                  links.arcs.data() + links.start[i + 1]};
    const int ends = counts.boundary_ends[i];
    if (component_count[i] == 0) {
      defects.push_back({i, CellDefect::Empty});
    } else if (component_count[i] > 1) {
      defects.push_back({i, CellDefect::Pieces});
    } else if (counts.twice_euler[i] != 2) {
      defects.push_back({i, CellDefect::Handle});
    } else if (ends > 2 || !is_proper_link(arcs, ends == 2)) {
      defects.push_back({i, CellDefect::DoubleEdge});
    }
  }
  return defects;
}

}  // namespace nonobtuse::rdt
