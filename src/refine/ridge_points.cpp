// The distance from M to T is largest where M bends: at its vertices, and where T's edges pass
// under sharp edges of M.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "refine/fidelity.h"

namespace nonobtuse::refine {
namespace {

constexpr std::size_t kChunk = 512;
constexpr double kSharp = 0.9;    // cosine between the normals at a sharp edge
constexpr double kNeedle = 0.02;  // area of a facet next to one of area 1
constexpr double kSpacing = 0.3;  // of points on sharp edges, where the size is 1
constexpr int kMostPoints = 7;    // on one edge

// Numbers the points of M's ridges: vertices first, then `kMostPoints` places for every edge, named
// by the facet of lower index.
class RidgePoints {
 public:
  explicit RidgePoints(const mesh::Surface& surface)
      : surface_(surface), seen_(surface.vertices.size() + 3 * surface.triangles.size(), 0) {}

  [[nodiscard]] std::int64_t count() const {
    return vertices() + std::int64_t{3 * kMostPoints} * std::ssize(surface_.triangles);
  }
  // Marks a point; false if it was marked before.
  bool mark(Index number) {
    const Index past = number - vertices();
    char& seen = past < 0 ? seen_[number] : seen_[vertices() + past / kMostPoints];
    const int bit = past < 0 ? 1 : 1 << past % kMostPoints;
    if (seen & bit) return false;
    seen = static_cast<char>(seen | bit);
    return true;
  }

  // Calls visit(number, point) for the points of a facet.
  template <class Visit>
  void of_facet(Index f, const Visit& visit) const {
    const Triangle& v = surface_.triangles[f];
    for (int k = 0; k < 3; ++k) visit(v[k], surface_.vertices[v[k]]);
    for (int k = 0; k < 3; ++k) {
      const Index g = surface_.adjacent[f][k];
      if (g < 0 || dot(surface_.normals[f], surface_.normals[g]) > kSharp) continue;
      // The normal of a needle says little.
      const double ratio = surface_.areas[f] / surface_.areas[g];
      if (ratio < kNeedle || ratio * kNeedle > 1) continue;
      Vec3 a = surface_.vertices[v[mesh::next(k)]], b = surface_.vertices[v[mesh::previous(k)]];
      const double size = surface_.size_at(f, {1.0 / 3, 1.0 / 3, 1.0 / 3});
      const double pieces =
          std::min(distance(a, b) / (kSpacing * size), static_cast<double>(kMostPoints + 1));
      const int points = static_cast<int>(std::ceil(pieces)) - 1;
      if (points <= 0) continue;
      Index owner = f;
      int corner = k;
      if (g < f) {
        owner = g;
        while (surface_.adjacent[g][corner = (corner + 1) % 3] != f) {
        }
        std::swap(a, b);
      }
      for (int i = 0; i < points; ++i)
        visit(vertices() + (3 * owner + corner) * kMostPoints + i,
              a + (i + 1.0) / (points + 1) * (b - a));
    }
  }

 private:
  [[nodiscard]] Index vertices() const { return static_cast<Index>(surface_.vertices.size()); }
  const mesh::Surface& surface_;
  std::vector<char> seen_;  // per vertex, then bits per edge
};

}  // namespace

Index Fidelity::emphasize_far_ridges(const mesh::EditableMesh& mesh, double far, double weight,
                                     double growth, const parallel::Workers& workers,
                                     const std::vector<Index>* triangles) {
  std::vector<Index> all;
  const bool few = triangles != nullptr;
  if (!few) {
    for (Index t = 0; t < static_cast<Index>(first.size()); ++t) all.push_back(t);
    triangles = &all;
  }
  RidgePoints ridges(surface());
  if (ridges.count() > std::numeric_limits<Index>::max()) return 0;
  Index count = 0;
  for (Index t : *triangles)
    for (Index s = first[t]; s >= 0; s = samples[s].next) {
      Sample& sample = samples[s];
      if (sample.ridge < 0) continue;
      ridges.mark(sample.ridge);
      const std::array<Vec3, 3> p = corners(mesh, t);
      const double d = TriangleFrame(p[0], p[1], p[2]).closest(sample.point).squared_distance;
      if (d > far * far) sample.weight *= growth, ++count;
    }
  // One candidate per point: walks start from the triangle of a sample of one of its facets.
  std::vector<Sample> candidates;
  std::vector<Index> nearest;
  Index before = -1;
  for (Index t : *triangles)
    for (Index s = first[t]; s >= 0; s = samples[s].next) {
      const Sample& sample = samples[s];
      if (sample.ridge >= 0 || sample.facet == before) continue;
      before = sample.facet;
      const auto add = [&](Index facet) {
        ridges.of_facet(facet, [&](Index number, const Vec3& point) {
          if (!ridges.mark(number)) return;
          const double local = surface().size_at(facet, {1.0 / 3, 1.0 / 3, 1.0 / 3});
          const double area = local * local;
          // With the facet of the sample, which is no needle.
          candidates.push_back(
              {point, weight * area * TargetSize::fidelity_factor(area), sample.facet, number});
          nearest.push_back(t);
        });
      };
      // Facets smaller than a sample's share may have none: their neighbours' count.
      add(sample.facet);
      for (const Index g : surface().adjacent[sample.facet]) {
        if (g < 0) continue;
        add(g);
        if (!few) continue;
        for (const Index f : surface().adjacent[g])
          if (f >= 0) add(f);
      }
    }
  std::vector<char> is_far(candidates.size());
  workers.for_each(candidates.size(), kChunk, [&](std::size_t i) {
    ClosestPoint closest;
    nearest[i] = walk_to_nearest(mesh, nearest[i], candidates[i], closest);
    is_far[i] = closest.squared_distance > far * far;
  });
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!is_far[i]) continue;
    ++count;
    candidates[i].next = first[nearest[i]];
    first[nearest[i]] = static_cast<Index>(samples.size());
    samples.push_back(candidates[i]);
  }
  return count;
}

}  // namespace nonobtuse::refine
