#include "refine/knots.h"

#include <algorithm>

#include "numeric/vec3.h"
#include "refine/fidelity.h"
#include "refine/neighborhood.h"

namespace nonobtuse::refine {

Knots::Knots(const mesh::CurveNetwork& network, const mesh::EditableMesh& mesh)
    : all(network.knots.size()), network_(&network) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].place = network.knots[k];
    all[k].slides = all[k].place.curve >= 0;
  }
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && mesh.knot[v] >= 0) all[mesh.knot[v]].copies.push_back(v);
  make_canonical();
  link_neighbors();
}

Knots::Knots(const Knots& whole, const mesh::EditableMesh& mesh, const std::vector<Index>& vertices,
             const std::vector<char>& inner, std::vector<Index>& old)
    : network_(whole.network_) {
  old.clear();
  if (whole.empty()) return;
  for (const Index v : vertices) {
    const Index knot = mesh.knot[v];
    if (knot < 0) continue;
    for (const Index k : {knot, whole.all[knot].before, whole.all[knot].after})
      if (k >= 0) old.push_back(k);
  }
  sort_unique(old);
  const auto renamed = [&](Index k) {
    const auto it = std::lower_bound(old.begin(), old.end(), k);
    return it != old.end() && *it == k ? static_cast<Index>(it - old.begin()) : Index{-1};
  };
  for (const Index k : old) {
    const SlidingKnot& from = whole.all[k];
    all.push_back({from.place,
                   from.before < 0 ? -1 : renamed(from.before),
                   from.after < 0 ? -1 : renamed(from.after),
                   from.slides,
                   {}});
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Index knot = mesh.knot[vertices[i]];
    if (knot < 0) continue;
    SlidingKnot& own = all[renamed(knot)];
    own.copies.push_back(static_cast<Index>(i));
    if (!inner[i]) own.slides = false;
  }
  for (std::size_t k = 0; k < old.size(); ++k)
    if (all[k].copies.size() != whole.all[old[k]].copies.size()) all[k].slides = false;
}

void Knots::link_neighbors() {
  std::vector<Index> order;
  for (Index k = 0; k < static_cast<Index>(all.size()); ++k)
    if (all[k].place.curve >= 0 && !all[k].copies.empty()) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const mesh::Knot &p = all[a].place, &q = all[b].place;
    return p.curve != q.curve ? p.curve < q.curve : p.arc != q.arc ? p.arc < q.arc : a < b;
  });
  Index first = -1, last = -1;  // of the curve that is being walked
  const auto close = [&] {
    if (first < 0 || !curve(first).closed) return;
    all[first].before = last;
    all[last].after = first;
  };
  for (const Index k : order) {
    if (last >= 0 && all[last].place.curve == all[k].place.curve) {
      all[last].after = k;
      all[k].before = last;
    } else {
      close();
      first = k;
    }
    last = k;
  }
  close();
}

void Knots::make_canonical() {
  for (Index k = 0; k < static_cast<Index>(all.size()); ++k)
    if (all[k].place.curve >= 0) all[k].place.arc = mesh::canonical_arc(curve(k), all[k].place.arc);
}

void Knots::store(mesh::CurveNetwork& network) const {
  if (empty()) return;
  network.knots.clear();
  for (const SlidingKnot& knot : all) {
    network.knots.push_back(knot.place);
    if (knot.place.curve < 0) continue;
    const mesh::Curve& curve = network.curves[knot.place.curve];
    network.knots.back().arc = mesh::canonical_arc(curve, knot.place.arc);
  }
}

double Knots::room_before(Index knot) const {
  const SlidingKnot& own = all[knot];
  if (own.before < 0) return std::max(0.0, own.place.arc);
  const double room = own.place.arc - all[own.before].place.arc;
  if (!curve(knot).closed) return std::max(0.0, room);
  const double turned = mesh::canonical_arc(curve(knot), room);
  return own.before == knot ? curve(knot).length : turned;
}

double Knots::room_after(Index knot) const {
  const SlidingKnot& own = all[knot];
  if (own.after < 0) return std::max(0.0, curve(knot).length - own.place.arc);
  const double room = all[own.after].place.arc - own.place.arc;
  if (!curve(knot).closed) return std::max(0.0, room);
  const double turned = mesh::canonical_arc(curve(knot), room);
  return own.after == knot ? curve(knot).length : turned;
}

double Knots::limited(Index knot, double step, double spacing) const {
  const double back = 0.5 * std::max(0.0, room_before(knot) - spacing);
  const double ahead = 0.5 * std::max(0.0, room_after(knot) - spacing);
  return std::clamp(step, -back, ahead);
}

void Knots::move(mesh::EditableMesh& mesh, Index knot, double arc) {
  SlidingKnot& own = all[knot];
  own.place.arc = arc;
  const Vec3 p = mesh::point_at(curve(knot), arc);
  for (const Index v : own.copies) mesh.positions[v] = p;
}

Index Knots::insert(const mesh::Knot& place, Index before, Index after) {
  const Index knot = static_cast<Index>(all.size());
  all.push_back({place, before, after, true, {}});
  if (before >= 0) all[before].after = knot;
  if (after >= 0) all[after].before = knot;
  return knot;
}

void Knots::remove(Index knot) {
  SlidingKnot& own = all[knot];
  if (own.before >= 0) all[own.before].after = own.after;
  if (own.after >= 0) all[own.after].before = own.before;
  own.copies.clear();
  own.slides = false;
}

bool Knots::edge_allowed(const mesh::EditableMesh& mesh, Index a, Index b) const {
  if (empty()) return true;
  const Index ka = mesh.knot[a], kb = mesh.knot[b];
  if (ka < 0 && kb < 0) return true;
  if (ka == kb) return false;
  if (ka < 0) return edge_allowed(mesh, b, a);
  const auto is_b = [&](Index u) { return kb < 0 ? u == b : mesh.knot[u] == kb; };
  bool allowed = true;
  for (const Index copy : all[ka].copies)
    for_ring(mesh, copy, [&](Index t, int) {
      const Triangle& corners = mesh.triangle(t);
      if (std::any_of(corners.begin(), corners.end(), is_b)) allowed = false;
    });
  return allowed;
}

bool Knots::collapse_allowed(const mesh::EditableMesh& mesh, Index removed, Index b) const {
  if (empty()) return true;
  if (mesh.knot[removed] >= 0) return false;
  bool allowed = true;
  for_ring(mesh, removed, [&](Index t, int k) {
    const Index u = mesh.triangle(t)[mesh::next(k)];
    if (u != b && !mesh.find_edge(u, b).valid() && !edge_allowed(mesh, b, u)) allowed = false;
  });
  return allowed;
}

bool Knots::add_copies(const mesh::EditableMesh& mesh, std::vector<Index>& vertices) const {
  if (empty()) return false;
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count; ++i)
    if (const Index knot = mesh.knot[vertices[i]]; knot >= 0)
      vertices.insert(vertices.end(), all[knot].copies.begin(), all[knot].copies.end());
  sort_unique(vertices);
  return vertices.size() > count;
}

}  // namespace nonobtuse::refine
