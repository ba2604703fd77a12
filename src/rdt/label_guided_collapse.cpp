// Link condition: Dey, Edelsbrunner, Guha, Nekhayev, 1999. The flood's key is the largest distance
// to the site met on the way, so that a label grows like a ball but stays on its sheet.
#include "rdt/label_guided_collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>
#include <tuple>

#include "nonobtuse/error.h"
#include "rdt/delaunay_flips.h"
#include "rdt/vertex_reduction.h"
#include "spatial/closest_point.h"

namespace nonobtuse::rdt {

namespace {

using mesh::Edge;
using mesh::EditableMesh;

// Longest edge of the copy, in units of the spacing of the sites.
constexpr double kResolution = 0.6;

class GuidedCollapse {
 public:
  GuidedCollapse(const mesh::Surface& surface, std::span<const Vec3> sites,
                 std::span<const Index> feet)
      : surface_(surface), sites_(sites), feet_(feet), mesh_(surface.vertices, surface.triangles) {
    facet_.resize(surface.triangles.size());
    for (std::size_t t = 0; t < facet_.size(); ++t) facet_[t] = static_cast<Index>(t);
  }

  // With prescribed vertices: they are the first of the sites.
  GuidedCollapse(const mesh::Surface& surface, std::span<const Vec3> sites,
                 std::span<const Index> feet, std::span<const Index> knots)
      : GuidedCollapse(surface, sites, feet) {
    knots_ = knots;
    prescribed_ = true;
  }

  CollapsedMesh run() {
    refine(kResolution *
           std::sqrt(2 / std::sqrt(3.0) * surface_.area / static_cast<double>(sites_.size())));
    insert_sites();
    if (prescribed_) claim_boundary();
    flood();
    if (!prescribed_) move_to_boundary();
    while (collapse_pass()) {
    }
    return prescribed_ ? finish_prescribed() : finish();
  }

 private:
  // Bisects edges, longest first, until none is longer than `bound` (times the local size).
  void refine(double bound) {
    struct Long {
      double squared;
      Index a, b;
      bool operator<(const Long& o) const {
        return std::tie(squared, o.a, o.b) < std::tie(o.squared, a, b);
      }
    };
    std::priority_queue<Long> queue;
    std::vector<double> size = surface_.size;  // grows with the splits; empty if uniform
    const auto push = [&](Index a, Index b) {
      const double squared = squared_distance(mesh_.positions[a], mesh_.positions[b]);
      const double local = size.empty() ? bound : bound * std::min(size[a], size[b]);
      if (squared > local * local) queue.push({squared, a, b});
    };
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
      for (int k = 0; k < 3; ++k)
        if (mesh_.adjacent(t, k) < t) push(mesh_.tail({t, k}), mesh_.head({t, k}));
    std::vector<Index> ring;
    while (!queue.empty()) {
      const auto [squared, a, b] = queue.top();
      queue.pop();
      const Edge e = mesh_.find_edge(a, b);
      const Edge o = mesh_.twin(e);
      const Index m = mesh_.split_edge(e, 0.5 * (mesh_.positions[a] + mesh_.positions[b]));
      if (!size.empty()) size.push_back(0.5 * (size[a] + size[b]));
      facet_.push_back(facet_[e.triangle]);
      if (o.valid()) facet_.push_back(facet_[o.triangle]);
      mesh_.neighbors(m, ring);
      for (const Index v : ring) push(m, v);
    }
  }

  // Makes every site a vertex, inside the triangle of its foot facet nearest to it.
  void insert_sites() {
    const auto count = static_cast<Index>(sites_.size());
    const auto knots = static_cast<Index>(knots_.size());
    std::vector<Index> start(surface_.triangles.size() + 1, 0);
    for (const Index f : facet_) ++start[f + 1];
    for (std::size_t f = 1; f < start.size(); ++f) start[f] += start[f - 1];
    std::vector<Index> parts(facet_.size());
    std::vector<Index> fill(start.begin(), start.end() - 1);
    for (std::size_t t = 0; t < facet_.size(); ++t)
      parts[fill[facet_[t]]++] = static_cast<Index>(t);

    std::vector<Index> order;
    for (Index i = knots; i < count; ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return feet_[i] < feet_[j]; });
    seed_.assign(count, -1);
    moved_.assign(count, 0);
    std::copy(knots_.begin(), knots_.end(), seed_.begin());
    std::vector<Index> open;
    Index open_facet = -1;
    for (const Index i : order) {
      const Index f = feet_[i];
      if (f != open_facet) open.assign(parts.begin() + start[f], parts.begin() + start[f + 1]);
      open_facet = f;
      double nearest = std::numeric_limits<double>::infinity();
      Index in = open.front();
      Vec3 at;
      for (const Index t : open) {
        const Triangle& c = mesh_.triangle(t);
        const auto closest = spatial::closest_point_on_triangle(
            sites_[i], mesh_.positions[c[0]], mesh_.positions[c[1]], mesh_.positions[c[2]]);
        if (closest.squared_distance < nearest) {
          nearest = closest.squared_distance;
          in = t;
          at = closest.point;
        }
      }
      seed_[i] = mesh_.split_triangle(in, at);
      for (int k = 0; k < 2; ++k) {
        open.push_back(static_cast<Index>(facet_.size()));
        facet_.push_back(f);
      }
    }
  }

  // Every boundary vertex belongs to the nearest knot along its loop.
  void claim_boundary() {
    claimed_.assign(mesh_.vertex_capacity(), -1);
    for (std::size_t i = 0; i < knots_.size(); ++i) claimed_[knots_[i]] = static_cast<Index>(i);
    const auto after = [&](Index v) {
      const Index t = mesh_.triangle_of(v);
      return mesh_.triangle(t)[mesh::next(mesh_.corner_of(t, v))];
    };
    std::vector<Index> run;
    std::vector<double> arc;
    for (std::size_t i = 0; i < knots_.size(); ++i) {
      if (!mesh_.on_boundary(knots_[i])) continue;
      run.assign(1, knots_[i]);
      arc.assign(1, 0);
      do {
        const Index v = after(run.back());
        arc.push_back(arc.back() + distance(mesh_.positions[run.back()], mesh_.positions[v]));
        run.push_back(v);
      } while (claimed_[run.back()] < 0 || !is_knot(run.back()));
      for (std::size_t k = 1; k + 1 < run.size(); ++k)
        claimed_[run[k]] = claimed_[2 * arc[k] <= arc.back() ? run.front() : run.back()];
    }
  }

  [[nodiscard]] bool is_knot(Index v) const {
    return claimed_[v] >= 0 && knots_[claimed_[v]] == v;
  }

  void flood() {
    struct Front {
      double key;
      Index vertex, site;
      bool operator<(const Front& o) const {  // the least key on top
        return std::tie(o.key, o.vertex, o.site) < std::tie(key, vertex, site);
      }
    };
    const Index vertices = mesh_.vertex_capacity();
    label_.assign(vertices, -1);
    key_.assign(vertices, std::numeric_limits<double>::infinity());
    std::priority_queue<Front> queue;
    for (Index i = 0; i < static_cast<Index>(seed_.size()); ++i) queue.push({0, seed_[i], i});
    for (Index v = 0; v < static_cast<Index>(claimed_.size()); ++v)
      if (claimed_[v] >= 0)
        queue.push({distance(mesh_.positions[v], sites_[claimed_[v]]), v, claimed_[v]});
    std::vector<Index> ring;
    while (!queue.empty()) {
      const Front at = queue.top();
      queue.pop();
      if (label_[at.vertex] >= 0) continue;
      label_[at.vertex] = at.site;
      key_[at.vertex] = at.key;
      mesh_.neighbors(at.vertex, ring);
      for (const Index v : ring)
        if (label_[v] < 0 && (!prescribed_ || claimed_[v] < 0))
          queue.push({std::max(at.key, distance(mesh_.positions[v], sites_[at.site])), v, at.site});
    }
    // Vertices of components without a site keep label -1 and an infinite key.
  }

  // A cell that reaches the boundary is represented there: boundary vertices cannot leave it.
  void move_to_boundary() {
    for (Index v = 0; v < mesh_.vertex_capacity(); ++v) {
      if (!mesh_.alive_vertex(v) || label_[v] < 0 || !mesh_.on_boundary(v)) continue;
      const Index i = label_[v];
      if (moved_[i] && key_[seed_[i]] <= key_[v]) continue;
      moved_[i] = 1;
      seed_[i] = v;
    }
  }

  // Collapses vertices, farthest first, into neighbours of the same label. Returns whether any.
  bool collapse_pass() {
    std::vector<Index> order;
    for (Index v = 0; v < mesh_.vertex_capacity(); ++v)
      if (mesh_.alive_vertex(v) && !is_seed(v)) order.push_back(v);
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return key_[a] != key_[b] ? key_[a] > key_[b] : a < b; });
    bool any = false;
    std::vector<Index> ring;
    for (const Index v : order) {
      mesh_.neighbors(v, ring);
      ring.erase(
          std::remove_if(ring.begin(), ring.end(), [&](Index a) { return label_[a] != label_[v]; }),
          ring.end());
      std::sort(ring.begin(), ring.end(), [&](Index a, Index b) {
        return std::make_tuple(!is_seed(a), key_[a], a) < std::make_tuple(!is_seed(b), key_[b], b);
      });
      for (const Index a : ring) {
        const Edge e = mesh_.find_edge(v, a);
        if (!mesh_.can_collapse(e, v)) continue;
        mesh_.collapse(e, v);
        any = true;
        break;
      }
    }
    return any;
  }

  [[nodiscard]] bool is_seed(Index v) const { return label_[v] >= 0 && seed_[label_[v]] == v; }

  // Boundary vertices that are left between two knots, since a chord of the mesh joins their
  // neighbours: the chord is split, then they go.
  void clear_boundary() {
    std::vector<Index> ring;
    for (bool again = true; again;) {
      again = false;
      for (Index v = 0; v < mesh_.vertex_capacity(); ++v) {
        if (!mesh_.alive_vertex(v) || !mesh_.on_boundary(v) || is_seed(v)) continue;
        mesh_.neighbors(v, ring);
        for (const Index a : {ring.front(), ring.back()}) {
          const Edge e = mesh_.find_edge(v, a);
          if (!mesh_.can_collapse(e, v)) split_chords(v, a);
          if (!mesh_.can_collapse(mesh_.find_edge(v, a), v)) continue;
          mesh_.collapse(mesh_.find_edge(v, a), v);
          again = true;
          break;
        }
      }
    }
  }

  // Splits the interior edges from v to those other than their triangle's apex that a is joined to.
  void split_chords(Index v, Index a) {
    const Index apex = mesh_.opposite_vertex(mesh_.find_edge(v, a));
    std::vector<Index> ring;
    mesh_.neighbors(v, ring);
    for (const Index w : ring) {
      if (w == a || w == apex || !mesh_.find_edge(a, w).valid()) continue;
      const Edge e = mesh_.find_edge(v, w);
      const Edge o = mesh_.twin(e);
      if (!o.valid()) continue;
      mesh_.split_edge(e, 0.5 * (mesh_.positions[v] + mesh_.positions[w]));
      label_.push_back(label_[v]);
      key_.push_back(key_[v]);
      facet_.push_back(facet_[e.triangle]);
      facet_.push_back(facet_[o.triangle]);
    }
  }

  CollapsedMesh finish_prescribed() {
    clear_boundary();
    mesh_.knot.assign(mesh_.vertex_capacity(), -1);
    for (std::size_t i = 0; i < knots_.size(); ++i) mesh_.knot[knots_[i]] = static_cast<Index>(i);
    return take_result();
  }

  CollapsedMesh finish() {
    CollapsedMesh result = take_result();
    const auto count = static_cast<Index>(sites_.size());
    if (result.mesh.vertex_count() > count)
      throw TooFewVertices("The topology of the surface needs more than the " +
                               std::to_string(count) + " vertices asked for: " +
                               std::to_string(result.mesh.vertex_count()) + " were reached.",
                           result.mesh.vertex_count());
    return result;
  }

  CollapsedMesh take_result() {
    CollapsedMesh result;
    std::vector<Index> foot(mesh_.vertex_capacity(), -1);
    std::vector<char> is_site(mesh_.vertex_capacity(), 0);
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
      if (mesh_.alive_triangle(t))
        for (const Index v : mesh_.triangle(t)) foot[v] = facet_[t];
    for (std::size_t i = 0; i < seed_.size(); ++i) {
      is_site[seed_[i]] = 1;
      if (moved_[i] || feet_[i] < 0) continue;
      mesh_.positions[seed_[i]] = sites_[i];
      foot[seed_[i]] = feet_[i];
    }
    const std::vector<Index> old = mesh_.compact();
    for (const Index v : old) result.foot.push_back(foot[v]);
    result.mesh = std::move(mesh_);
    const Index count = static_cast<Index>(sites_.size());
    result.extra = result.mesh.vertex_count() - count;
    delaunay_flips(surface_, result.foot, result.mesh);
    reduce_vertices(surface_, count, result.mesh, result.foot);
    delaunay_flips(surface_, result.foot, result.mesh);
    return result;
  }

  const mesh::Surface& surface_;
  std::span<const Vec3> sites_;
  std::span<const Index> feet_;
  EditableMesh mesh_;
  std::vector<Index> facet_;  // of the surface, for each triangle of the copy
  std::vector<Index> seed_;   // the vertex of each site
  std::vector<char> moved_;   // the site is represented by a boundary vertex
  std::span<const Index> knots_;
  bool prescribed_ = false;
  std::vector<Index> claimed_;  // the knot of each boundary vertex, if prescribed
  std::vector<Index> label_;
  std::vector<double> key_;
};

}  // namespace

CollapsedMesh label_guided_collapse(const mesh::Surface& surface, std::span<const Vec3> sites,
                                    std::span<const Index> feet) {
  return GuidedCollapse(surface, sites, feet).run();
}

CollapsedMesh label_guided_collapse(const mesh::Surface& surface, std::span<const Index> knots,
                                    std::span<const Vec3> sites, std::span<const Index> feet) {
  std::vector<Vec3> all;
  std::vector<Index> all_feet(knots.size(), -1);
  for (const Index v : knots) all.push_back(surface.vertices[v]);
  all.insert(all.end(), sites.begin(), sites.end());
  all_feet.insert(all_feet.end(), feet.begin(), feet.end());
  return GuidedCollapse(surface, all, all_feet, knots).run();
}

}  // namespace nonobtuse::rdt
