// Link condition: Dey, Edelsbrunner, Guha, Nekhayev, Topology preserving edge contraction, 1999.
// Boundaries are read as if every loop were coned to a vertex of its own.
#include "mesh/editable_mesh.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace nonobtuse::mesh {

EditableMesh::EditableMesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles)
    : positions(std::move(vertices)), triangles_(std::move(triangles)) {
  const Index count = static_cast<Index>(positions.size());
  adjacent_ = triangle_adjacency(triangles_, count);
  vertex_triangle_.assign(count, -1);
  valence_.assign(count, 0);
  triangle_count_ = static_cast<Index>(triangles_.size());
  for (Index t = 0; t < triangle_count_; ++t) {
    for (int k = 0; k < 3; ++k) {
      const Index v = triangles_[t][k];
      const bool first = adjacent_[t][previous(k)] < 0;
      valence_[v] += first ? 2 : 1;
      if (first || vertex_triangle_[v] < 0) vertex_triangle_[v] = t;
    }
  }
  for (Index v = 0; v < count; ++v) vertex_count_ += vertex_triangle_[v] >= 0 ? 1 : 0;
}

void EditableMesh::triangles_around(Index v, std::vector<Index>& out) const {
  out.clear();
  const Index first = vertex_triangle_[v];
  Index t = first;
  do {
    out.push_back(t);
    t = adjacent_[t][next(corner_of(t, v))];
  } while (t >= 0 && t != first);
}

void EditableMesh::neighbors(Index v, std::vector<Index>& out) const {
  out.clear();
  const Index first = vertex_triangle_[v];
  Index t = first;
  do {
    const int k = corner_of(t, v);
    out.push_back(triangles_[t][next(k)]);
    const Index following = adjacent_[t][next(k)];
    if (following < 0) out.push_back(triangles_[t][previous(k)]);
    t = following;
  } while (t >= 0 && t != first);
}

Edge EditableMesh::find_edge(Index a, Index b) const {
  const Index first = vertex_triangle_[a];
  Index t = first;
  do {
    const int k = corner_of(t, a);
    if (triangles_[t][next(k)] == b) return {t, previous(k)};
    const Index following = adjacent_[t][next(k)];
    // The last neighbour of a boundary vertex is seen only from the side b -> a.
    if (following < 0 && triangles_[t][previous(k)] == b) return {t, next(k)};
    t = following;
  } while (t >= 0 && t != first);
  return {};
}

bool EditableMesh::can_flip(Edge e) const {
  const Edge o = twin(e);
  if (!o.valid()) return false;
  const Index p = opposite_vertex(e);
  const Index q = opposite_vertex(o);
  const auto spare = [&](Index v) { return valence_[v] > (on_boundary(v) ? 2 : 3); };
  return p != q && spare(tail(e)) && spare(head(e)) && !find_edge(p, q).valid();
}

Edge EditableMesh::flip(Edge e) {
  // (p, a, b) + (q, b, a)  ->  (p, a, q) + (q, b, p)
  const Edge o = twin(e);
  const Index t = e.triangle;
  const Index u = o.triangle;
  const int k = e.corner;
  const int l = o.corner;
  const Index p = opposite_vertex(e);
  const Index q = opposite_vertex(o);
  const Index a = tail(e);
  const Index b = head(e);
  const Edge across_bp = twin({t, next(k)});
  const Edge across_aq = twin({u, next(l)});
  triangles_[t][previous(k)] = q;
  triangles_[u][previous(l)] = p;
  join({t, k}, across_aq);
  join({u, l}, across_bp);
  join({t, next(k)}, {u, next(l)});
  // p and q keep their first triangles; a leaves u and b leaves t.
  if (vertex_triangle_[a] == u) vertex_triangle_[a] = t;
  if (vertex_triangle_[b] == t) vertex_triangle_[b] = u;
  --valence_[a];
  --valence_[b];
  ++valence_[p];
  ++valence_[q];
  return {t, next(k)};
}

bool EditableMesh::can_collapse(Edge e, Index removed) const {
  const Index kept = tail(e) == removed ? head(e) : tail(e);
  const Edge o = twin(e);
  const Index c = opposite_vertex(e);
  const Index d = o.valid() ? opposite_vertex(o) : -1;
  if (on_boundary(removed)) {
    // Along its loop only, and not if the component is a single triangle.
    if (o.valid()) return false;
    if (adjacent_[e.triangle][next(e.corner)] < 0 && adjacent_[e.triangle][previous(e.corner)] < 0)
      return false;
  }
  // A tetrahedron: both ends have valence 3 (their links share the edge cd).
  if (valence_[removed] == 3 && valence_[kept] == 3 && d >= 0 && !on_boundary(removed) &&
      !on_boundary(kept))
    return false;
  // Common neighbours of the ends must be exactly the opposite vertices.
  const auto is_neighbor_of_kept = [&](Index v) { return find_edge(kept, v).valid(); };
  const Index first = vertex_triangle_[removed];
  Index t = first;
  do {
    const int k = corner_of(t, removed);
    const Index v = triangles_[t][next(k)];
    if (v != kept && v != c && v != d && is_neighbor_of_kept(v)) return false;
    const Index following = adjacent_[t][next(k)];
    if (following < 0) {
      const Index last = triangles_[t][previous(k)];
      if (last != kept && last != c && last != d && is_neighbor_of_kept(last)) return false;
    }
    t = following;
  } while (t >= 0 && t != first);
  return true;
}

void EditableMesh::collapse(Edge e, Index removed) {
  const Index kept = tail(e) == removed ? head(e) : tail(e);
  const Edge o = twin(e);
  const bool boundary = on_boundary(removed) || on_boundary(kept);
  const Index first = vertex_triangle_[removed];
  Index t = first;
  Index survivor = -1;  // a triangle that keeps on living around `kept`
  do {
    const int k = corner_of(t, removed);
    const Index following = adjacent_[t][next(k)];
    if (t != e.triangle && t != o.triangle) {
      triangles_[t][k] = kept;
      survivor = t;
    }
    t = following;
  } while (t >= 0 && t != first);
  if (survivor < 0) {  // `removed` had no other triangles: a corner of the boundary
    const Edge kept_side{e.triangle, corner_of(e.triangle, removed)};
    survivor = adjacent_[kept_side.triangle][kept_side.corner];
  }
  valence_[kept] += valence_[removed] - (o.valid() ? 4 : 3);
  close_up(e.triangle, e.corner);
  if (o.valid()) close_up(o.triangle, o.corner);
  vertex_triangle_[removed] = -1;
  valence_[removed] = 0;
  --vertex_count_;
  if (boundary) {
    set_first_triangle(kept, survivor);
  } else {
    vertex_triangle_[kept] = survivor;
  }
}

void EditableMesh::close_up(Index t, int apex) {
  const Index c = triangles_[t][apex];
  // Found by position, not by vertices (as twin does): those are renamed already.
  const auto outside = [&](int k) {
    const Index n = adjacent_[t][k];
    for (int l = 0; n >= 0 && l < 3; ++l)
      if (adjacent_[n][l] == t) return Edge{n, l};
    return Edge{};
  };
  const Edge after = outside(next(apex));       // across (last, apex): follows t around the apex
  const Edge before = outside(previous(apex));  // across (apex, first)
  if (vertex_triangle_[c] == t)
    vertex_triangle_[c] = after.valid() ? after.triangle : before.triangle;
  join(after, before);
  --valence_[c];
  triangles_[t] = {-1, -1, -1};
  adjacent_[t] = {-1, -1, -1};
  --triangle_count_;
}

Index EditableMesh::split_edge(Edge e, const Vec3& position) {
  const Edge o = twin(e);
  const Index t = e.triangle;
  const int k = e.corner;
  const Index p = opposite_vertex(e);
  const Index a = tail(e);
  const Index b = head(e);
  const Index m = add_vertex(position, o.valid() ? 4 : 3);
  // (p, a, b) -> (p, a, m) + (p, m, b)
  const Edge across_bp = twin({t, next(k)});
  const Index t2 = add_triangle({p, m, b});
  triangles_[t][previous(k)] = m;
  join({t2, 1}, across_bp);
  join({t, next(k)}, {t2, 2});
  if (vertex_triangle_[b] == t) vertex_triangle_[b] = t2;
  vertex_triangle_[m] = t2;
  ++valence_[p];
  if (!o.valid()) {
    join({t, k}, {});
    join({t2, 0}, {});
    return m;
  }
  // (q, b, a) -> (q, b, m) + (q, m, a)
  const Index u = o.triangle;
  const int l = o.corner;
  const Index q = opposite_vertex(o);
  const Edge across_aq = twin({u, next(l)});
  const Index u2 = add_triangle({q, m, a});
  triangles_[u][previous(l)] = m;
  join({u2, 1}, across_aq);
  join({u, next(l)}, {u2, 2});
  join({t, k}, {u2, 0});
  join({t2, 0}, {u, l});
  if (vertex_triangle_[a] == u) vertex_triangle_[a] = u2;
  ++valence_[q];
  return m;
}

Index EditableMesh::split_triangle(Index t, const Vec3& position) {
  const auto [a, b, c] = triangles_[t];
  const Index m = add_vertex(position, 3);
  const Edge across_bc = twin({t, 0});
  const Edge across_ca = twin({t, 1});
  const Index t1 = add_triangle({b, c, m});
  const Index t2 = add_triangle({c, a, m});
  triangles_[t][2] = m;
  join({t1, 2}, across_bc);
  join({t2, 2}, across_ca);
  join({t, 0}, {t1, 1});
  join({t1, 0}, {t2, 1});
  join({t2, 0}, {t, 1});
  if (vertex_triangle_[b] == t) vertex_triangle_[b] = t1;
  if (vertex_triangle_[c] == t) vertex_triangle_[c] = t2;
  vertex_triangle_[m] = t;
  ++valence_[a];
  ++valence_[b];
  ++valence_[c];
  return m;
}

std::vector<Index> EditableMesh::compact() {
  std::vector<Index> old_vertex;
  std::vector<Index> new_vertex(positions.size(), -1);
  for (Index v = 0; v < vertex_capacity(); ++v) {
    if (!alive_vertex(v)) continue;
    new_vertex[v] = static_cast<Index>(old_vertex.size());
    positions[old_vertex.size()] = positions[v];
    if (!knot.empty()) knot[old_vertex.size()] = knot[v];
    old_vertex.push_back(v);
  }
  positions.resize(old_vertex.size());
  std::vector<Index> kept_knot = std::move(knot);
  if (!kept_knot.empty()) kept_knot.resize(old_vertex.size());
  std::vector<Triangle> triangles;
  triangles.reserve(triangle_count_);
  for (const Triangle& t : triangles_)
    if (t[0] >= 0) triangles.push_back({new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]});
  *this = EditableMesh(std::move(positions), std::move(triangles));
  knot = std::move(kept_knot);
  return old_vertex;
}

TriangleMesh EditableMesh::to_mesh() const {
  EditableMesh copy = *this;
  copy.compact();
  return {std::move(copy.positions), std::move(copy.triangles_)};
}

void EditableMesh::check_invariants() const {
  const auto require = [](bool holds, const char* what, Index at) {
    if (!holds) throw std::logic_error(std::string(what) + " at " + std::to_string(at));
  };
  Index alive_triangles = 0;
  std::vector<int> corners(positions.size(), 0);
  for (Index t = 0; t < triangle_capacity(); ++t) {
    if (!alive_triangle(t)) continue;
    ++alive_triangles;
    const Triangle& c = triangles_[t];
    require(c[0] != c[1] && c[1] != c[2] && c[2] != c[0], "repeated vertex in triangle", t);
    for (int k = 0; k < 3; ++k) {
      require(c[k] >= 0 && c[k] < vertex_capacity() && alive_vertex(c[k]), "dead vertex", t);
      ++corners[c[k]];
      const Edge e{t, k};
      const Edge o = twin(e);
      if (!o.valid()) continue;
      require(alive_triangle(o.triangle) && tail(o) == head(e) && head(o) == tail(e) &&
                  adjacent_[o.triangle][o.corner] == t,
              "broken adjacency of triangle", t);
      require(opposite_vertex(o) != opposite_vertex(e), "folded edge of triangle", t);
    }
  }
  require(alive_triangles == triangle_count_, "wrong triangle count", triangle_count_);
  Index alive_vertices = 0;
  std::vector<Index> ring;
  for (Index v = 0; v < vertex_capacity(); ++v) {
    if (!alive_vertex(v)) continue;
    ++alive_vertices;
    triangles_around(v, ring);
    require(static_cast<int>(ring.size()) == corners[v], "not one fan around vertex", v);
    neighbors(v, ring);
    require(static_cast<int>(ring.size()) == valence_[v], "wrong valence of vertex", v);
    std::sort(ring.begin(), ring.end());
    require(std::adjacent_find(ring.begin(), ring.end()) == ring.end(), "double edge at vertex", v);
  }
  require(alive_vertices == vertex_count_, "wrong vertex count", vertex_count_);
}

void EditableMesh::join(Edge e, Edge other) {
  if (e.valid()) adjacent_[e.triangle][e.corner] = other.triangle;
  if (other.valid()) adjacent_[other.triangle][other.corner] = e.triangle;
}

void EditableMesh::set_first_triangle(Index v, Index t) {
  Index first = t;
  for (;;) {
    const Index preceding = adjacent_[first][previous(corner_of(first, v))];
    if (preceding < 0 || preceding == t) break;
    first = preceding;
  }
  vertex_triangle_[v] = first;
}

Index EditableMesh::add_vertex(const Vec3& position, int valence) {
  positions.push_back(position);
  if (!knot.empty()) knot.push_back(-1);
  vertex_triangle_.push_back(-1);
  valence_.push_back(valence);
  ++vertex_count_;
  return vertex_capacity() - 1;
}

Index EditableMesh::add_triangle(const Triangle& corners) {
  triangles_.push_back(corners);
  adjacent_.push_back({-1, -1, -1});
  ++triangle_count_;
  return triangle_capacity() - 1;
}

}  // namespace nonobtuse::mesh
