#include "remesh/unavoidable_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/sector_valence.h"
#include "spatial/kd_tree.h"

namespace nonobtuse::pipeline {

namespace {

constexpr double kLeastAngle = 30;  // of the promise, degrees
constexpr int kSmallest = 31;       // with a degree to spare
constexpr int kLargest = 89;
constexpr double kRadian = 3.14159265358979323846 / 180;
constexpr double kInwards = 0.3;  // cosine: how squarely an edge faces a vertex

// Of one triangle with `degrees` at the corner: the largest angle opposite one edge, the smallest
// opposite the other.
double ratio_of_one(int degrees) {
  const int b = std::min(kLargest, 180 - degrees - kSmallest);
  return std::sin(b * kRadian) / std::sin((180 - degrees - b) * kRadian);
}

// By the degrees of the sector.
std::array<double, 361> largest_ratios() {
  std::array<double, 361> most{};
  most[0] = 1;
  for (int sum = kSmallest; sum <= 360; ++sum)
    for (int last = kSmallest; last <= std::min(sum, kLargest); ++last)
      most[sum] = std::max(most[sum], most[sum - last] * ratio_of_one(last));
  return most;
}

class FrozenBoundary {
 public:
  FrozenBoundary(const mesh::EditableMesh& mesh, const mesh::CurveNetwork& network)
      : mesh_(mesh), network_(network) {
    for (Index t = 0; t < mesh.triangle_capacity(); ++t)
      for (int k = 0; k < 3 && mesh.alive_triangle(t); ++k) {
        if (mesh.adjacent(t, k) >= 0) continue;
        const mesh::Edge e{t, k};
        edges_.push_back(e);
        out_[mesh.tail(e)] = in_[mesh.head(e)] = e;
      }
  }

  std::vector<NarrowCorner> run() {
    find_uneven_sectors();
    find_faced_edges();
    std::vector<NarrowCorner> corners;
    for (const auto& [knot, degrees] : found_) corners.push_back({knot, degrees, 0});
    return corners;
  }

 private:
  [[nodiscard]] bool fixed(Index v) const {
    return mesh_.knot[v] >= 0 && network_.knots[mesh_.knot[v]].curve < 0;
  }
  [[nodiscard]] double length_of(const mesh::Edge& e) const {
    return distance(mesh_.positions[mesh_.tail(e)], mesh_.positions[mesh_.head(e)]);
  }
  void add(Index v) { found_.emplace(mesh_.knot[v], sector_degrees(v)); }

  [[nodiscard]] double sector_degrees(Index v) const {
    std::vector<Index> around;
    mesh_.triangles_around(v, around);
    double degrees = 0;
    for (const Index t : around) {
      const int k = mesh_.corner_of(t, v);
      const Triangle& c = mesh_.triangle(t);
      degrees += mesh::corner_degrees(mesh_.positions[v], mesh_.positions[c[mesh::next(k)]],
                                      mesh_.positions[c[mesh::previous(k)]]);
    }
    return degrees;
  }

  void find_uneven_sectors() {
    for (const auto& [v, after] : out_) {
      const auto before = in_.find(v);
      if (before == in_.end() || !fixed(v) || !fixed(mesh_.head(after)) ||
          !fixed(mesh_.tail(before->second)))
        continue;
      const double a = length_of(after), b = length_of(before->second);
      if (std::max(a, b) > largest_length_ratio(sector_degrees(v)) * std::min(a, b)) add(v);
    }
  }

  // A triangle with angles above 30 degrees beside an edge covers the one with 30 degrees.
  void find_faced_edges() {
    std::vector<Vec3> points;
    for (const auto& [v, e] : out_)
      if (fixed(v)) points.push_back(mesh_.positions[v]);
    if (points.empty()) return;
    const spatial::NearestSites index(points);
    std::vector<spatial::NearestSites::Neighbor> near;
    for (const mesh::Edge& e : edges_) {
      if (!fixed(mesh_.tail(e)) || !fixed(mesh_.head(e))) continue;
      const Vec3& a = mesh_.positions[mesh_.tail(e)];
      const Vec3& b = mesh_.positions[mesh_.head(e)];
      index.within(0.5 * (a + b), 0.5 * distance(a, b), near);
      if (std::any_of(near.begin(), near.end(),
                      [&](const auto& n) { return faces(e, points[n.site]); }))
        add(mesh_.tail(e)), add(mesh_.head(e));
    }
  }

  [[nodiscard]] bool faces(const mesh::Edge& e, const Vec3& p) const {
    const Vec3& a = mesh_.positions[mesh_.tail(e)];
    const Vec3& b = mesh_.positions[mesh_.head(e)];
    if (p == a || p == b) return false;
    const Vec3 along = normalized(b - a);
    const auto across = [&](const Vec3& q) { return q - a - dot(q - a, along) * along; };
    const Vec3 offset = across(p);
    if (dot(offset, normalized(across(mesh_.positions[mesh_.opposite_vertex(e)]))) <=
        kInwards * length(offset))
      return false;
    return mesh::corner_degrees(a, b, p) < kLeastAngle &&
           mesh::corner_degrees(b, a, p) < kLeastAngle;
  }

  const mesh::EditableMesh& mesh_;
  const mesh::CurveNetwork& network_;
  std::vector<mesh::Edge> edges_;         // of the boundary
  std::map<Index, mesh::Edge> out_, in_;  // by their tail, by their head
  std::map<Index, double> found_;         // degrees by knot
};

}  // namespace

double largest_length_ratio(double degrees) {
  static const std::array<double, 361> most = largest_ratios();
  return most[static_cast<std::size_t>(std::lround(std::clamp(degrees, 0.0, 360.0)))];
}

std::vector<NarrowCorner> narrow_sectors(const features::CutSurface& cut,
                                         const mesh::CurveNetwork& network) {
  std::vector<double> angle(cut.knot.size(), 0);
  const std::vector<Vec3>& x = cut.surface.vertices;
  for (const Triangle& t : cut.surface.triangles)
    for (int k = 0; k < 3; ++k)
      if (cut.knot[t[k]] >= 0)
        angle[t[k]] += mesh::corner_degrees(x[t[k]], x[t[mesh::next(k)]], x[t[mesh::previous(k)]]);
  std::vector<NarrowCorner> corners;
  for (std::size_t v = 0; v < angle.size(); ++v) {
    const Index k = cut.knot[v];
    if (k >= 0 && network.knots[k].curve < 0 && angle[v] < kLeastAngle)
      corners.push_back({k, angle[v], 0});
  }
  return corners;
}

std::vector<NarrowCorner> frozen_corners(const mesh::EditableMesh& mesh,
                                         const mesh::CurveNetwork& network) {
  return FrozenBoundary(mesh, network).run();
}

}  // namespace nonobtuse::pipeline
