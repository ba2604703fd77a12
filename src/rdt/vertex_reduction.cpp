// Shortest edges first; Dey, Edelsbrunner, Guha, Nekhayev, 1999 for the link condition.
#include "rdt/vertex_reduction.h"

#include <algorithm>
#include <tuple>

#include "rdt/delaunay_flips.h"

namespace nonobtuse::rdt {

namespace {

using mesh::Edge;
using mesh::EditableMesh;

enum class Guard { NormalsAndCrossings, Normals, None };

// Whether segment (p, q) passes through triangle (a, b, c); doubles, a guard and not a proof.
bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = area_vector(a, b, c);
  const double sp = dot(n, p - a);
  const double sq = dot(n, q - a);
  if ((sp > 0) == (sq > 0)) return false;
  const Vec3 x = p + sp / (sp - sq) * (q - p);
  return dot(n, area_vector(a, b, x)) >= 0 && dot(n, area_vector(b, c, x)) >= 0 &&
         dot(n, area_vector(c, a, x)) >= 0;
}

class Reducer {
 public:
  Reducer(const mesh::Surface& surface, EditableMesh& mesh, const std::vector<Index>& foot)
      : surface_(surface), mesh_(mesh), foot_(foot) {}

  // One pass over the edges by length (relative to the local size); returns the number of
  // collapses.
  Index pass(Index count, Guard guard) {
    struct Candidate {
      double length2;
      Index removed, kept;
    };
    std::vector<Candidate> all;
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) {
      if (!mesh_.alive_triangle(t)) continue;
      for (int k = 0; k < 3; ++k) {
        const Index a = mesh_.tail({t, k});
        const Index b = mesh_.head({t, k});
        const double l = squared_distance(mesh_.positions[a], mesh_.positions[b]) / squared_size(a);
        all.push_back({l, a, b});
        if (mesh_.adjacent(t, k) < 0) all.push_back({l, b, a});
      }
    }
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.length2, a.removed, a.kept) < std::tie(b.length2, b.removed, b.kept);
    });
    Index done = 0;
    std::vector<char> touched(mesh_.vertex_capacity(), 0);
    for (const Candidate& c : all) {
      if (mesh_.vertex_count() <= count) break;
      if (touched[c.removed] || touched[c.kept]) continue;
      if (!mesh_.alive_vertex(c.removed) || !mesh_.alive_vertex(c.kept)) continue;
      if (!mesh_.knot.empty() && mesh_.knot[c.removed] >= 0) continue;
      const Edge e = mesh_.find_edge(c.removed, c.kept);
      if (!e.valid() || !mesh_.can_collapse(e, c.removed) || !allowed(c.removed, c.kept, guard))
        continue;
      mesh_.neighbors(c.removed, ring_);
      for (const Index v : ring_) touched[v] = 1;
      mesh_.collapse(e, c.removed);
      ++done;
    }
    return done;
  }

 private:
  [[nodiscard]] double squared_size(Index v) const {
    if (surface_.size.empty()) return 1;
    const double s = surface_.size_at(foot_[v], {1.0 / 3, 1.0 / 3, 1.0 / 3});
    return s * s;
  }

  bool allowed(Index removed, Index kept, Guard guard) {
    if (guard == Guard::None) return true;
    mesh_.triangles_around(removed, ring_);
    fan_.clear();
    for (const Index t : ring_) {
      Triangle c = mesh_.triangle(t);
      if (std::find(c.begin(), c.end(), kept) != c.end()) continue;
      std::replace(c.begin(), c.end(), removed, kept);
      const Vec3 n =
          area_vector(mesh_.positions[c[0]], mesh_.positions[c[1]], mesh_.positions[c[2]]);
      // Against the surface, or so thin that its normal means nothing.
      if (!(dot(n, reference_normal(surface_, foot_, c)) > 0.2 * length(n))) return false;
      fan_.push_back(c);
    }
    return guard == Guard::Normals || !fan_crosses(removed);
  }

  // Whether a triangle of the new fan crosses any of the mesh outside the fan of `removed`.
  [[nodiscard]] bool fan_crosses(Index removed) const {
    const auto& x = mesh_.positions;
    for (const Triangle& c : fan_) {
      const Vec3 low = min(x[c[0]], min(x[c[1]], x[c[2]]));
      const Vec3 high = max(x[c[0]], max(x[c[1]], x[c[2]]));
      for (const Triangle& d : mesh_.triangles()) {
        if (d[0] < 0 || std::find(d.begin(), d.end(), removed) != d.end()) continue;
        const Vec3 l = min(x[d[0]], min(x[d[1]], x[d[2]]));
        const Vec3 h = max(x[d[0]], max(x[d[1]], x[d[2]]));
        if (l.x > high.x || l.y > high.y || l.z > high.z || h.x < low.x || h.y < low.y ||
            h.z < low.z)
          continue;
        if (edge_crosses(c, d) || edge_crosses(d, c)) return true;
      }
    }
    return false;
  }

  // Whether an edge of c that has no corner of d passes through d.
  [[nodiscard]] bool edge_crosses(const Triangle& c, const Triangle& d) const {
    const auto in_d = [&](Index v) { return std::find(d.begin(), d.end(), v) != d.end(); };
    const auto& x = mesh_.positions;
    for (int k = 0; k < 3; ++k) {
      const Index a = c[k];
      const Index b = c[mesh::next(k)];
      if (!in_d(a) && !in_d(b) && crosses(x[a], x[b], x[d[0]], x[d[1]], x[d[2]])) return true;
    }
    return false;
  }

  const mesh::Surface& surface_;
  EditableMesh& mesh_;
  const std::vector<Index>& foot_;
  std::vector<Index> ring_;
  std::vector<Triangle> fan_;
};

}  // namespace

void reduce_vertices(const mesh::Surface& surface, Index count, EditableMesh& mesh,
                     std::vector<Index>& foot) {
  if (mesh.vertex_count() <= count) return;
  Reducer reducer(surface, mesh, foot);
  for (const Guard guard : {Guard::NormalsAndCrossings, Guard::Normals, Guard::None})
    while (mesh.vertex_count() > count && reducer.pass(count, guard) > 0)
      delaunay_flips(surface, foot, mesh, 3);
  const std::vector<Index> old = mesh.compact();
  for (std::size_t v = 0; v < old.size(); ++v) foot[v] = foot[old[v]];
  foot.resize(old.size());
}

}  // namespace nonobtuse::rdt
