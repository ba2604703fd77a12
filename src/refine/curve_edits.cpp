#include "refine/curve_edits.h"

#include <algorithm>
#include <utility>

namespace nonobtuse::refine {
namespace {

// The new knot between two neighbours: where it lies and between which it comes.
struct Gap {
  bool valid = false;
  Index before = -1, after = -1;  // -1: a corner at the curve's end
  mesh::Knot middle;
};

Gap gap_between(const mesh::EditableMesh& mesh, const Knots& knots, Index a, Index b) {
  Index k = mesh.knot[a], l = mesh.knot[b];
  if (k < 0 || l < 0) return {};
  if (!knots.all[k].slides) std::swap(k, l);
  if (!knots.all[k].slides) return {};
  const SlidingKnot& own = knots.all[k];
  const mesh::Curve& curve = knots.curve(k);
  bool ahead = own.after == l, behind = own.before == l;
  if (knots.all[l].place.curve < 0) {  // a corner; the curve may start and end at it
    const Vec3 corner = mesh.positions[knots.all[l].copies.front()];
    ahead = own.after < 0 && mesh::point_at(curve, curve.length) == corner;
    behind = own.before < 0 && mesh::point_at(curve, 0) == corner;
  }
  if (ahead == behind) return {};
  Gap gap{true, ahead ? k : own.before, ahead ? own.after : k, own.place};
  gap.middle.arc += ahead ? 0.5 * knots.room_after(k) : -0.5 * knots.room_before(k);
  return gap;
}

// The boundary edges at copy `c` towards copies of a knot: one, but two at the end of a dangling
// crease, which has one copy for both sides.
std::vector<mesh::Edge> edges_towards(const mesh::EditableMesh& mesh, Index c, Index knot) {
  std::vector<mesh::Edge> found;
  for_ring(mesh, c, [&](Index t, int) {
    for (int k = 0; k < 3; ++k) {
      const mesh::Edge e{t, k};
      if (mesh.adjacent(t, k) >= 0) continue;
      const Index u = mesh.tail(e) == c ? mesh.head(e) : mesh.head(e) == c ? mesh.tail(e) : -1;
      if (u >= 0 && mesh.knot[u] == knot) found.push_back(e);
    }
  });
  return found;
}

mesh::Edge edge_towards(const mesh::EditableMesh& mesh, Index c, Index knot) {
  const std::vector<mesh::Edge> edges = edges_towards(mesh, c, knot);
  return edges.size() == 1 ? edges.front() : mesh::Edge{};
}

bool keeps_sides(const mesh::EditableMesh& mesh, Index removed, Index kept) {
  bool keeps = true;
  for_ring(mesh, removed, [&](Index t, int k) {
    std::array<Vec3, 3> p = corners(mesh, t);
    const Triangle& v = mesh.triangle(t);
    if (v[0] == kept || v[1] == kept || v[2] == kept) return;
    const Vec3 before = area_vector(p);
    p[k] = mesh.positions[kept];
    const Vec3 after = area_vector(p);
    if (!(dot(before, after) > 0.2 * length(before) * length(after))) keeps = false;
  });
  return keeps;
}

// New triangles and vertices get entries of their own.
void grow(const mesh::EditableMesh& mesh, Fidelity& fidelity, std::vector<Index>& concerned) {
  for (Index t = static_cast<Index>(fidelity.first.size()); t < mesh.triangle_capacity(); ++t) {
    fidelity.first.push_back(-1);
    fidelity.edge_planes.emplace_back();
    fidelity.edge_weights.push_back(0);
    concerned.push_back(t);
  }
}

void renew(const mesh::EditableMesh& mesh, Fidelity& fidelity,
           const std::vector<Index>& concerned) {
  fidelity.redistribute(mesh, concerned);
  for (const Index t : concerned)
    if (mesh.alive_triangle(t)) fidelity.update_triangle(mesh, t);
}

// By vertices: a split renames the other edges of its triangle.
std::vector<std::pair<Index, Index>> ends_of(const mesh::EditableMesh& mesh,
                                             const std::vector<mesh::Edge>& sides) {
  std::vector<std::pair<Index, Index>> ends;
  for (const mesh::Edge& e : sides) ends.emplace_back(mesh.tail(e), mesh.head(e));
  return ends;
}

Index split_side(mesh::EditableMesh& mesh, Knots& knots, const mesh::Edge& side, Index knot) {
  const Index m =
      mesh.split_edge(side, mesh::point_at(knots.curve(knot), knots.all[knot].place.arc));
  mesh.knot[m] = knot;
  knots.all[knot].copies.push_back(m);
  return m;
}

}  // namespace

std::vector<mesh::Edge> curve_sides(const mesh::EditableMesh& mesh, const Knots& knots, Index a,
                                    Index b) {
  std::vector<mesh::Edge> sides;
  for (const Index c : knots.all[mesh.knot[a]].copies)
    for (const mesh::Edge& e : edges_towards(mesh, c, mesh.knot[b])) sides.push_back(e);
  return sides;
}

bool can_split_curve(const mesh::EditableMesh& mesh, const Knots& knots, Index a, Index b) {
  return gap_between(mesh, knots, a, b).valid && !curve_sides(mesh, knots, a, b).empty();
}

std::vector<Index> split_curve(mesh::EditableMesh& mesh, Knots& knots, Index a, Index b) {
  const Gap gap = gap_between(mesh, knots, a, b);
  const std::vector<mesh::Edge> sides = curve_sides(mesh, knots, a, b);
  const Index knot = knots.insert(gap.middle, gap.before, gap.after);
  std::vector<Index> made;
  for (const auto& [tail, head] : ends_of(mesh, sides))
    made.push_back(split_side(mesh, knots, mesh.find_edge(tail, head), knot));
  return made;
}

std::vector<Index> split_curve(mesh::EditableMesh& mesh, Fidelity& fidelity, Index a, Index b) {
  const Gap gap = gap_between(mesh, fidelity.knots, a, b);
  const std::vector<mesh::Edge> sides = curve_sides(mesh, fidelity.knots, a, b);
  const Index knot = fidelity.knots.insert(gap.middle, gap.before, gap.after);
  std::vector<Index> made;
  for (const auto& [tail, head] : ends_of(mesh, sides)) {
    const mesh::Edge side = mesh.find_edge(tail, head);
    std::vector<Index> concerned{side.triangle};
    const Index m = split_side(mesh, fidelity.knots, side, knot);
    made.push_back(m);
    fidelity.vertex_planes.emplace_back();
    fidelity.vertex_weights.push_back(0);
    fidelity.size.add_between(tail, head);
    fidelity.patches.add_beside(tail);
    fidelity.valences.measure(mesh, m);
    grow(mesh, fidelity, concerned);
    renew(mesh, fidelity, concerned);
    fidelity.update_vertex(mesh, m);
  }
  return made;
}

bool can_collapse_curve(const mesh::EditableMesh& mesh, const Knots& knots, Index removed,
                        Index kept) {
  const Index k = mesh.knot[removed], l = mesh.knot[kept];
  if (k < 0 || l < 0 || k == l || !knots.all[k].slides) return false;
  const SlidingKnot& own = knots.all[k];
  if (knots.curve(k).closed &&
      (own.before == own.after || knots.all[own.before].before == own.after))
    return false;
  // Towards the end of a dangling crease both sides would collapse onto one vertex.
  if (knots.all[l].copies.size() < own.copies.size()) return false;
  std::vector<Index> targets;
  for (const Index c : own.copies) {
    const mesh::Edge e = edge_towards(mesh, c, l);
    if (!e.valid()) return false;
    const Index to = mesh.tail(e) == c ? mesh.head(e) : mesh.tail(e);
    if (std::find(targets.begin(), targets.end(), to) != targets.end()) return false;
    targets.push_back(to);
    if (!mesh.can_collapse(e, c) || !keeps_sides(mesh, c, to)) return false;
    bool allowed = true;
    const auto check = [&](Index u) {
      if (u != to && !mesh.find_edge(u, to).valid() && !knots.edge_allowed(mesh, to, u))
        allowed = false;
    };
    for_ring(mesh, c, [&](Index t, int corner) {
      check(mesh.triangle(t)[mesh::next(corner)]);
      check(mesh.triangle(t)[mesh::previous(corner)]);
    });
    if (!allowed) return false;
  }
  return true;
}

void collapse_curve(mesh::EditableMesh& mesh, Knots& knots, Index removed, Index kept) {
  const Index k = mesh.knot[removed], l = mesh.knot[kept];
  for (const Index c : knots.all[k].copies) {
    const mesh::Edge e = edge_towards(mesh, c, l);
    if (e.valid()) mesh.collapse(e, c);
  }
  knots.remove(k);
}

void collapse_curve(mesh::EditableMesh& mesh, Fidelity& fidelity, Index removed, Index kept) {
  const Index k = mesh.knot[removed], l = mesh.knot[kept];
  std::vector<Index> concerned;
  for (const Index c : fidelity.knots.all[k].copies) {
    const mesh::Edge e = edge_towards(mesh, c, l);
    if (!e.valid()) continue;
    mesh.triangles_around(c, concerned);
    mesh.collapse(e, c);
    // A side of one triangle hands its samples to what is beside it.
    if (std::none_of(concerned.begin(), concerned.end(),
                     [&](Index t) { return mesh.alive_triangle(t); }))
      for (const Index kept_copy : fidelity.knots.all[l].copies)
        if (fidelity.patches.same_patch(kept_copy, c))
          for_ring(mesh, kept_copy, [&](Index t, int) { concerned.push_back(t); });
    renew(mesh, fidelity, concerned);
  }
  fidelity.knots.remove(k);
}

}  // namespace nonobtuse::refine
