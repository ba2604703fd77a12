// Clipping: Yan, Levy, Liu, Sun, Wang, Isotropic Remeshing with Fast and Exact Computation of
// Restricted Voronoi Diagram, 2009. A piece is kept as the cyclic list of its sides alone; every
// decision is one predicate on a corner, named by the two sides that meet there.
#include "rvd/restricted_voronoi.h"

#include <algorithm>
#include <numeric>

#include "spatial/closest_point.h"

namespace nonobtuse::rvd {

namespace {

using numeric::Corner;
using numeric::SidePredicates;

constexpr std::size_t kFacetsPerChunk = 512;
// From this many candidates on they are tried by distance, so that pieces shrink early.
constexpr int kSortedFrom = 9;

// The facet cut into pieces by its candidates (local indices throughout).
class FacetClipper {
 public:
  void reset(const mesh::Surface& surface, std::span<const Vec3> sites,
             const FacetCandidates& candidates, Index facet) {
    const Triangle& t = surface.triangles[facet];
    vertices_ = {surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]};
    predicates_.reset(vertices_, sites, candidates.of(facet));
    drop_dominated();
  }

  [[nodiscard]] const std::vector<int>& contenders() const { return contenders_; }

  // Sides of the piece of candidate i; empty if it has none.
  const std::vector<Side>& clip(int i) {
    sides_ = {edge_side(2), edge_side(0), edge_side(1)};
    corners_.clear();
    for (int m = 0; m < 3; ++m)
      corners_.push_back(predicates_.corner(i, sides_[(m + 2) % 3], sides_[m]));
    for (const int j : order_around(i)) {
      if (j != i) cut(i, j);
      if (sides_.empty()) break;
    }
    return sides_;
  }

 private:
  // A candidate farther than another at all three vertices, beyond rounding, owns nothing.
  void drop_dominated() {
    contenders_.clear();
    const int count = predicates_.candidate_count();
    const double margin = predicates_.difference_error();
    const auto farther = [&](int i, int than) {
      const auto& di = predicates_.distances(i);
      const auto& dj = predicates_.distances(than);
      return di[0] > dj[0] + margin && di[1] > dj[1] + margin && di[2] > dj[2] + margin;
    };
    int nearest = 0;
    const auto worst = [&](int i) {
      const auto& d = predicates_.distances(i);
      return std::max(d[0], std::max(d[1], d[2]));
    };
    for (int i = 1; i < count; ++i)
      if (worst(i) < worst(nearest)) nearest = i;
    for (int i = 0; i < count; ++i)
      if (!farther(i, nearest)) contenders_.push_back(i);
  }

  const std::vector<int>& order_around(int i) {
    if (static_cast<int>(contenders_.size()) < kSortedFrom) return contenders_;
    order_ = contenders_;
    const auto key = [&](int j) {
      const auto& di = predicates_.distances(i);
      const auto& dj = predicates_.distances(j);
      // Small where the bisector cuts deep into the part near i.
      return dj[0] - di[0] + dj[1] - di[1] + dj[2] - di[2];
    };
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
      const double ka = key(a);
      const double kb = key(b);
      return ka != kb ? ka < kb : a < b;
    });
    return order_;
  }

  // Keeps the part of the piece nearer to i than to j.
  void cut(int i, int j) {
    // The whole facet on one side, beyond rounding: no need to look at the corners.
    const auto& di = predicates_.distances(i);
    const auto& dj = predicates_.distances(j);
    const double margin = predicates_.difference_error();
    const auto [least, most] = std::minmax({di[0] - dj[0], di[1] - dj[1], di[2] - dj[2]});
    if (most < -margin) return;
    if (least > margin) {
      sides_.clear();
      return;
    }
    const std::size_t count = sides_.size();
    outside_.resize(count);
    bool any = false;
    for (std::size_t m = 0; m < count; ++m) {
      outside_[m] = predicates_.side(i, corners_[m], j) > 0;
      any = any || outside_[m];
    }
    if (!any) return;
    new_sides_.clear();
    new_corners_.clear();
    for (std::size_t m = 0; m < count; ++m) {
      const std::size_t n = m + 1 == count ? 0 : m + 1;
      if (!outside_[m]) {
        new_sides_.push_back(sides_[m]);
        new_corners_.push_back(corners_[m]);
        if (outside_[n]) {
          new_sides_.push_back(j);
          new_corners_.push_back(predicates_.corner(i, sides_[m], j));
        }
      } else if (!outside_[n]) {
        new_sides_.push_back(sides_[m]);
        new_corners_.push_back(predicates_.corner(i, j, sides_[m]));
      }
    }
    sides_.swap(new_sides_);
    corners_.swap(new_corners_);
  }

  std::array<Vec3, 3> vertices_{};
  SidePredicates predicates_;
  std::vector<int> contenders_;
  std::vector<int> order_;
  std::vector<Side> sides_;
  std::vector<Side> new_sides_;
  std::vector<Corner> corners_;  // corner m: start of side m
  std::vector<Corner> new_corners_;
  std::vector<char> outside_;
};

// The pieces of a run of facets; starts are relative.
struct Part {
  std::vector<Index> pieces_of_facet;
  std::vector<Index> site;
  std::vector<Index> sides_of_piece;
  std::vector<Side> sides;
};

void clip_facet(FacetClipper& clipper, const mesh::Surface& surface, std::span<const Vec3> sites,
                const FacetCandidates& candidates, Index facet, Part& part) {
  const std::span<const Index> list = candidates.of(facet);
  const std::size_t before = part.site.size();
  const auto add = [&](int candidate, const std::vector<Side>& sides) {
    part.site.push_back(list[candidate]);
    part.sides_of_piece.push_back(static_cast<Index>(sides.size()));
    for (const Side s : sides) part.sides.push_back(is_edge(s) ? s : list[s]);
  };
  clipper.reset(surface, sites, candidates, facet);
  if (clipper.contenders().size() == 1) {
    part.site.push_back(list[clipper.contenders().front()]);
    part.sides_of_piece.push_back(3);
    part.sides.insert(part.sides.end(), {edge_side(2), edge_side(0), edge_side(1)});
    part.pieces_of_facet.push_back(1);
    return;
  }
  for (const int i : clipper.contenders()) {
    const std::vector<Side>& sides = clipper.clip(i);
    if (!sides.empty()) add(i, sides);
  }
  part.pieces_of_facet.push_back(static_cast<Index>(part.site.size() - before));
}

}  // namespace

Index RestrictedVoronoi::find(Index facet, Index of_site) const {
  const auto begin = site.begin() + facet_start[facet];
  const auto end = site.begin() + facet_start[facet + 1];
  const auto it =
      end - begin < 8 ? std::find(begin, end, of_site) : std::lower_bound(begin, end, of_site);
  return it != end && *it == of_site ? static_cast<Index>(it - site.begin()) : -1;
}

Index RestrictedVoronoi::across(const mesh::Surface& surface, Index facet, Index piece,
                                int k) const {
  const Index other = surface.adjacent[facet][k];
  return other < 0 ? -1 : find(other, site[piece]);
}

RestrictedVoronoi restricted_voronoi(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const FacetCandidates& candidates,
                                     const parallel::Workers& workers) {
  const std::size_t facets = surface.triangles.size();
  std::vector<Part> parts((facets + kFacetsPerChunk - 1) / kFacetsPerChunk);
  workers.for_chunks(
      facets, kFacetsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        FacetClipper clipper;
        Part& part = parts[chunk];
        part.pieces_of_facet.reserve(end - begin);
        part.site.reserve(4 * (end - begin));
        part.sides_of_piece.reserve(4 * (end - begin));
        part.sides.reserve(16 * (end - begin));
        for (std::size_t f = begin; f < end; ++f)
          clip_facet(clipper, surface, sites, candidates, static_cast<Index>(f), part);
      });

  RestrictedVoronoi diagram;
  std::size_t pieces = 0;
  std::size_t sides = 0;
  for (const Part& part : parts) {
    pieces += part.site.size();
    sides += part.sides.size();
  }
  diagram.facet_start.reserve(facets + 1);
  diagram.site.reserve(pieces);
  diagram.side_start.reserve(pieces + 1);
  diagram.sides.reserve(sides);
  diagram.facet_start.push_back(0);
  diagram.side_start.push_back(0);
  for (const Part& part : parts) {
    for (const Index count : part.pieces_of_facet)
      diagram.facet_start.push_back(diagram.facet_start.back() + count);
    for (const Index count : part.sides_of_piece)
      diagram.side_start.push_back(diagram.side_start.back() + count);
    diagram.site.insert(diagram.site.end(), part.site.begin(), part.site.end());
    diagram.sides.insert(diagram.sides.end(), part.sides.begin(), part.sides.end());
  }
  return diagram;
}

Vec3 corner_position(const mesh::Surface& surface, std::span<const Vec3> sites, Index facet,
                     Index site, Side before, Side after) {
  const Triangle& t = surface.triangles[facet];
  const std::array<Vec3, 3> v{surface.vertices[t[0]], surface.vertices[t[1]],
                              surface.vertices[t[2]]};
  if (is_edge(before) && is_edge(after)) return v[3 - edge_of(before) - edge_of(after)];
  const auto line = [&](Side s) -> std::array<double, 3> {
    if (is_edge(s)) {
      std::array<double, 3> l{0, 0, 0};
      l[edge_of(s)] = -1;
      return l;
    }
    std::array<double, 3> l{};
    const Vec3 across = sites[s] - sites[site];
    for (int k = 0; k < 3; ++k) l[k] = dot(across, (v[k] - sites[site]) + (v[k] - sites[s]));
    return l;
  };
  const auto a = line(before);
  const auto b = line(after);
  std::array<double, 3> w{};
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    // Exactly non-negative; what is not is rounding.
    w[k] = std::max(
        0.0, a[mesh::next(k)] * b[mesh::previous(k)] - a[mesh::previous(k)] * b[mesh::next(k)]);
    sum += w[k];
  }
  if (!(sum > 0)) {  // a cut through a tie: any point of the sides will do
    if (is_edge(before)) return v[mesh::next(edge_of(before))];
    if (is_edge(after)) return v[mesh::next(edge_of(after))];
    return (v[0] + v[1] + v[2]) / 3;
  }
  return (w[0] * v[0] + w[1] * v[1] + w[2] * v[2]) / sum;
}

void corner_positions(const mesh::Surface& surface, std::span<const Vec3> sites,
                      const RestrictedVoronoi& diagram, Index facet, Index piece,
                      std::vector<Vec3>& out) {
  out.clear();
  const std::span<const Side> sides = diagram.sides_of(piece);
  for (std::size_t m = 0; m < sides.size(); ++m)
    out.push_back(corner_position(surface, sites, facet, diagram.site[piece],
                                  sides[m == 0 ? sides.size() - 1 : m - 1], sides[m]));
}

std::vector<DualSegment> dual_segments(const mesh::Surface& surface, std::span<const Vec3> sites,
                                       const RestrictedVoronoi& diagram) {
  std::vector<DualSegment> segments;
  std::vector<Vec3> corners;
  for (Index f = 0; f + 1 < static_cast<Index>(diagram.facet_start.size()); ++f) {
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const std::span<const Side> sides = diagram.sides_of(p);
      const Index i = diagram.site[p];
      if (std::none_of(sides.begin(), sides.end(), [&](Side s) { return s > i; })) continue;
      corner_positions(surface, sites, diagram, f, p, corners);
      for (std::size_t m = 0; m < sides.size(); ++m)
        if (sides[m] > i)
          segments.push_back({i, sides[m], f, corners[m], corners[(m + 1) % sides.size()]});
    }
  }
  return segments;
}

std::vector<DualEdge> dual_edges(const mesh::Surface& surface, std::span<const Vec3> sites,
                                 const RestrictedVoronoi& diagram) {
  std::vector<DualSegment> segments = dual_segments(surface, sites, diagram);
  std::stable_sort(segments.begin(), segments.end(),
                   [](const DualSegment& a, const DualSegment& b) {
                     return a.site != b.site ? a.site < b.site : a.other < b.other;
                   });
  std::vector<DualEdge> edges;
  for (const DualSegment& s : segments) {
    if (edges.empty() || edges.back().site != s.site || edges.back().other != s.other)
      edges.push_back({s.site, s.other, 0});
    edges.back().length += distance(s.from, s.to);
  }
  return edges;
}

CellSums cell_sums(const mesh::Surface& surface, std::span<const Vec3> sites,
                   const RestrictedVoronoi& diagram, std::span<const Index> owner) {
  CellSums result;
  result.mass.assign(sites.size(), 0);
  result.centroid.assign(sites.size(), Vec3{});
  const bool uniform = surface.size.empty();
  result.sites.assign(uniform ? 0 : sites.size(), 0);
  std::vector<Vec3> corners;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const Triangle& t = surface.triangles[f];
    for (Index p = diagram.facet_start[f]; p < diagram.facet_start[f + 1]; ++p) {
      const Index i = owner[p];
      corner_positions(surface, sites, diagram, f, p, corners);
      // Fan of triangles, coordinates relative to the site.
      for (Vec3& c : corners) c -= sites[i];
      for (std::size_t m = 1; m + 1 < corners.size(); ++m) {
        const Vec3& a = corners[0];
        const Vec3& b = corners[m];
        const Vec3& c = corners[m + 1];
        double area = 0.5 * length(area_vector(a, b, c));
        if (!uniform) {
          const auto foot =
              spatial::closest_point_on_triangle(sites[i] + (a + b + c) / 3, surface.vertices[t[0]],
                                                 surface.vertices[t[1]], surface.vertices[t[2]]);
          const double size = surface.size_at(f, foot.barycentric);
          result.sites[i] += area / (size * size);
          area /= size * size * size * size;
        }
        result.mass[i] += area;
        result.centroid[i] += area / 3 * (a + b + c);
        result.energy +=
            area / 6 * (dot(a, a) + dot(b, b) + dot(c, c) + dot(a, b) + dot(b, c) + dot(c, a));
      }
    }
  }
  for (std::size_t i = 0; i < sites.size(); ++i)
    result.centroid[i] =
        sites[i] + (result.mass[i] > 0 ? result.centroid[i] / result.mass[i] : Vec3{});
  return result;
}

}  // namespace nonobtuse::rvd
