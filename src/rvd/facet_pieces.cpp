#include "rvd/facet_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/hilbert_order.h"

namespace nonobtuse::rvd {
namespace {

constexpr double kLongestEdge = 2;       // times h
constexpr double kCellsPerChunk = 64;    // more: fewer sites shared by chunks; fewer: finer margins
constexpr Index kPiecesPerChunk = 4096;  // bound for facets much smaller than cells

// Along an edge the size may vary by this factor, unless the edge is short beside it.
constexpr double kVariation = 1.3;
constexpr double kShortEdge = 0.1;

struct Builder {
  std::vector<Vec3> vertices;
  std::vector<double> size;
  std::vector<std::array<Index, 3>> corners;
  std::vector<Index> facet;

  // Whether an edge is too long for the local size or for a linear density.
  [[nodiscard]] bool too_long(const std::array<Index, 3>& t, double length2, double h) const {
    if (size.empty()) return length2 > kLongestEdge * h * (kLongestEdge * h);
    const auto [least, most] = std::minmax({size[t[0]], size[t[1]], size[t[2]]});
    const double bound = (most > kVariation * least ? kShortEdge : kLongestEdge) * least * h;
    return length2 > bound * bound;
  }

  // Longest-edge bisection, ties to the first edge; an explicit stack, for needles.
  void split(const std::array<Index, 3>& triangle, Index source, double h) {
    std::vector<std::array<Index, 3>> stack{triangle};
    while (!stack.empty()) {
      const std::array<Index, 3> t = stack.back();
      stack.pop_back();
      int longest = 0;
      double length2 = -1;
      for (int k = 0; k < 3; ++k) {
        const double l2 =
            squared_distance(vertices[t[mesh::next(k)]], vertices[t[mesh::previous(k)]]);
        if (l2 > length2) {
          length2 = l2;
          longest = k;
        }
      }
      if (!too_long(t, length2, h)) {
        corners.push_back(t);
        facet.push_back(source);
        continue;
      }
      const Index a = t[longest];
      const Index b = t[mesh::next(longest)];
      const Index c = t[mesh::previous(longest)];
      const auto middle = static_cast<Index>(vertices.size());
      vertices.push_back(0.5 * (vertices[b] + vertices[c]));
      if (!size.empty()) size.push_back(0.5 * (size[b] + size[c]));
      stack.push_back({a, middle, c});
      stack.push_back({a, b, middle});
    }
  }
};

void make_chunks(FacetPieces& pieces, double cell_area) {
  pieces.chunk_start.push_back(0);
  double filled = 0;
  double largest = 0;
  spatial::Box box;
  for (Index p = 0; p < pieces.count(); ++p) {
    for (const Index v : pieces.corners[p]) {
      box.add(pieces.vertices[v]);
      if (!pieces.uniform()) largest = std::max(largest, pieces.size[v]);
    }
    filled += sites_of(pieces, p);
    const Index size = p + 1 - pieces.chunk_start.back();
    if (filled >= kCellsPerChunk * cell_area || size == kPiecesPerChunk ||
        p + 1 == pieces.count()) {
      pieces.chunk_start.push_back(p + 1);
      pieces.box.push_back(box);
      if (!pieces.uniform()) pieces.chunk_size.push_back(largest);
      box = {};
      filled = 0;
      largest = 0;
    }
  }
}

}  // namespace

FacetPieces facet_pieces(const mesh::Surface& surface, Index site_count) {
  FacetPieces pieces;
  const double cell_area = surface.area / std::max<Index>(site_count, 1);
  pieces.spacing = std::sqrt(2 / std::sqrt(3.0) * cell_area);
  Builder b;
  b.vertices = surface.vertices;
  b.size = surface.size;
  b.corners.reserve(surface.triangles.size());
  b.facet.reserve(surface.triangles.size());
  // A surface without area is left as it is.
  const double h = pieces.spacing > 0 ? pieces.spacing : std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    b.split(surface.triangles[f], static_cast<Index>(f), h);

  std::vector<Vec3> centers;
  centers.reserve(b.corners.size());
  for (const auto& t : b.corners)
    centers.push_back((b.vertices[t[0]] + b.vertices[t[1]] + b.vertices[t[2]]) / 3);
  const std::vector<Index> order = spatial::hilbert_order(centers);

  std::vector<Index> renumbered(b.vertices.size(), -1);
  pieces.corners.reserve(order.size());
  pieces.facet.reserve(order.size());
  pieces.area.reserve(order.size());
  for (const Index p : order) {
    std::array<Index, 3> t = b.corners[p];
    pieces.area.push_back(
        0.5 * length(area_vector(b.vertices[t[0]], b.vertices[t[1]], b.vertices[t[2]])));
    for (Index& v : t) {
      if (renumbered[v] < 0) {
        renumbered[v] = static_cast<Index>(pieces.vertices.size());
        pieces.vertices.push_back(b.vertices[v]);
        if (!b.size.empty()) pieces.size.push_back(b.size[v]);
      }
      v = renumbered[v];
    }
    pieces.corners.push_back(t);
    pieces.facet.push_back(b.facet[p]);
  }
  make_chunks(pieces, cell_area);
  return pieces;
}

}  // namespace nonobtuse::rvd
