#include "refine/patch.h"

#include <algorithm>
#include <tuple>

#include "refine/curve_edits.h"
#include "refine/neighborhood.h"

namespace nonobtuse::refine {
namespace {

// New triangles of a flip must look the way the old ones do, on the whole.
bool flip_keeps_sides(const mesh::EditableMesh& mesh, mesh::Edge e) {
  const mesh::Edge o = mesh.twin(e);
  const std::vector<Vec3>& x = mesh.positions;
  const Vec3 a = x[mesh.tail(e)], b = x[mesh.head(e)];
  const Vec3 p = x[mesh.opposite_vertex(e)], q = x[mesh.opposite_vertex(o)];
  const Vec3 mean = area_vector(p, a, b) + area_vector(q, b, a);
  const double least = 0.02 * squared_length(mean);
  return dot(area_vector(p, a, q), mean) > least && dot(area_vector(q, b, p), mean) > least;
}

// After removing a into b: no triangle of a turns over.
bool collapse_keeps_sides(const mesh::EditableMesh& mesh, Index a, Index b) {
  bool keeps = true;
  for_ring(mesh, a, [&](Index t, int k) {
    std::array<Vec3, 3> p = corners(mesh, t);
    const Triangle& v = mesh.triangle(t);
    if (v[0] == b || v[1] == b || v[2] == b) return;
    const Vec3 before = area_vector(p);
    p[k] = mesh.positions[b];
    const Vec3 after = area_vector(p);
    if (!(dot(before, after) > 0.2 * length(before) * length(after))) keeps = false;
  });
  return keeps;
}

// Separate fans that the triangles of a sorted list form around v.
int fans_around(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles, Index v) {
  int fans = 0, first = -1, before = 0;
  for_ring(mesh, v, [&](Index t, int) {
    const int in = std::binary_search(triangles.begin(), triangles.end(), t);
    if (first < 0) first = in;
    fans += in && !before;
    before = in;
  });
  return fans - (fans > 1 && first && before && !mesh.on_boundary(v));
}

// All triangles of the vertices `core`; vertices where these would meet in two fans join the core,
// and all copies of knots.
std::vector<Index> triangles_of(const mesh::EditableMesh& mesh, const Knots& knots,
                                std::vector<Index>& core) {
  for (;;) {
    std::vector<Index> triangles, vertices, pinched;
    for (Index v : core) for_ring(mesh, v, [&](Index t, int) { triangles.push_back(t); });
    sort_unique(triangles);
    for (Index t : triangles)
      for (Index v : mesh.triangle(t)) vertices.push_back(v);
    sort_unique(vertices);
    for (Index v : vertices)
      if (fans_around(mesh, triangles, v) > 1) pinched.push_back(v);
    if (pinched.empty()) return triangles;
    core.insert(core.end(), pinched.begin(), pinched.end());
    sort_unique(core);
    knots.add_copies(mesh, core);
  }
}

}  // namespace

bool edit_possible(const mesh::EditableMesh& mesh, const Knots& knots, const Edit& edit) {
  if (edit.kind == Edit::Kind::CollapseCurve)
    return can_collapse_curve(mesh, knots, edit.a, edit.b);
  if (edit.kind == Edit::Kind::SplitCurve) return can_split_curve(mesh, knots, edit.a, edit.b);
  const mesh::Edge e = mesh.find_edge(edit.a, edit.b);
  if (!e.valid()) return false;
  switch (edit.kind) {
    case Edit::Kind::Flip:
      return mesh.can_flip(e) && flip_keeps_sides(mesh, e) &&
             knots.edge_allowed(mesh, mesh.opposite_vertex(e), mesh.opposite_vertex(mesh.twin(e)));
    case Edit::Kind::Collapse:
      return !mesh.on_boundary(edit.a) && mesh.can_collapse(e, edit.a) &&
             collapse_keeps_sides(mesh, edit.a, edit.b) &&
             knots.collapse_allowed(mesh, edit.a, edit.b);
    case Edit::Kind::Split:
      return mesh.twin(e).valid();
    default:
      return false;
  }
  return false;
}

std::vector<Index> apply_edit(mesh::EditableMesh& mesh, Knots& knots, const Edit& edit) {
  switch (edit.kind) {
    case Edit::Kind::Flip:
      mesh.flip(mesh.find_edge(edit.a, edit.b));
      break;
    case Edit::Kind::Collapse:
      mesh.collapse(mesh.find_edge(edit.a, edit.b), edit.a);
      break;
    case Edit::Kind::Split:
      return {mesh.split_edge(mesh.find_edge(edit.a, edit.b),
                              0.5 * (mesh.positions[edit.a] + mesh.positions[edit.b]))};
    case Edit::Kind::CollapseCurve:
      collapse_curve(mesh, knots, edit.a, edit.b);
      break;
    case Edit::Kind::SplitCurve:
      return split_curve(mesh, knots, edit.a, edit.b);
  }
  return {};
}

std::vector<Index> apply_edit(mesh::EditableMesh& mesh, Fidelity& fidelity, const Edit& edit) {
  if (edit.kind == Edit::Kind::SplitCurve) return split_curve(mesh, fidelity, edit.a, edit.b);
  if (edit.kind == Edit::Kind::CollapseCurve) {
    collapse_curve(mesh, fidelity, edit.a, edit.b);
    return {};
  }
  const mesh::Edge e = mesh.find_edge(edit.a, edit.b);
  std::vector<Index> concerned;
  if (edit.kind == Edit::Kind::Collapse) {
    mesh.triangles_around(edit.a, concerned);
  } else {
    concerned = {e.triangle, mesh.twin(e).triangle};
  }
  const std::vector<Index> made = apply_edit(mesh, fidelity.knots, edit);
  for (Index t = static_cast<Index>(fidelity.first.size()); t < mesh.triangle_capacity(); ++t) {
    fidelity.first.push_back(-1);
    fidelity.edge_planes.emplace_back();
    fidelity.edge_weights.push_back(0);
    concerned.push_back(t);
  }
  // Before samples go to triangles of the new vertex, whose size they ask for.
  for (std::size_t i = 0; i < made.size(); ++i) {
    fidelity.vertex_planes.emplace_back();
    fidelity.vertex_weights.push_back(0);
    fidelity.size.add_between(edit.a, edit.b);
    fidelity.patches.add_beside(edit.a);
  }
  fidelity.redistribute(mesh, concerned);
  for (const Index m : made) {
    fidelity.update_vertex(mesh, m);
  }
  for (Index t : concerned)
    if (mesh.alive_triangle(t)) fidelity.update_triangle(mesh, t);
  return made;
}

bool PatchScore::operator<(const PatchScore& other) const {
  return std::tie(folded, bad_valence, outside_promise, outside_goal, distance, energy) <
         std::tie(other.folded, other.bad_valence, other.outside_promise, other.outside_goal,
                  other.distance, other.energy);
}

bool is_folded(const mesh::EditableMesh& mesh, const Fidelity& fidelity, Index t) {
  const Vec3 normal = normalized(area_vector(corners(mesh, t)));
  int against = 0;
  for (Index v : mesh.triangle(t)) {
    const Index facet = fidelity.vertex_planes[v].facet;
    against += facet >= 0 && dot(fidelity.surface().normals[facet], normal) < 0;
  }
  if (against == 3) return true;
  for (int k = 0; k < 3; ++k) {
    const Index u = mesh.adjacent(t, k);
    if (u >= 0 && dot(normalized(area_vector(corners(mesh, u))), normal) < -0.8) return true;
  }
  return false;
}

Patch::Patch(const mesh::EditableMesh& whole, const Fidelity& whole_fidelity,
             std::span<const Index> center, int rings)
    : fidelity(whole_fidelity.surface(), whole_fidelity.surface_bvh()) {
  std::vector<Index> core(center.begin(), center.end());
  const Knots& knots = whole_fidelity.knots;
  knots.add_copies(whole, core);
  for (int ring = 0; ring < rings; ++ring) {
    add_rings(whole, core, 1);
    knots.add_copies(whole, core);
  }
  sort_unique(core);
  triangle = triangles_of(whole, knots, core);
  for (Index t : triangle)
    for (Index v : whole.triangle(t)) vertex.push_back(v);
  sort_unique(vertex);

  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  for (Index v : vertex) positions.push_back(whole.positions[v]);
  for (Index t : triangle) {
    const Triangle& v = whole.triangle(t);
    triangles.push_back({local(v[0]), local(v[1]), local(v[2])});
  }
  mesh = mesh::EditableMesh(std::move(positions), std::move(triangles));

  fidelity.weights = whole_fidelity.weights;
  fidelity.leash = whole_fidelity.leash;
  for (Index t : triangle) {
    fidelity.edge_planes.push_back(whole_fidelity.edge_planes[t]);
    fidelity.edge_weights.push_back(whole_fidelity.edge_weights[t]);
    Index head = -1;
    for (Index s = whole_fidelity.first[t]; s >= 0; s = whole_fidelity.samples[s].next) {
      fidelity.samples.push_back(whole_fidelity.samples[s]);
      fidelity.samples.back().next = head;
      head = static_cast<Index>(fidelity.samples.size()) - 1;
    }
    fidelity.first.push_back(head);
  }
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const Index v = vertex[i];
    fidelity.vertex_planes.push_back(whole_fidelity.vertex_planes[v]);
    fidelity.vertex_weights.push_back(whole_fidelity.vertex_weights[v]);
    if (!whole_fidelity.size.uniform())
      fidelity.size.of_vertex.push_back(whole_fidelity.size.at(v));
    hidden_.push_back(whole.valence(v) - mesh.valence(static_cast<Index>(i)));
    boundary_.push_back(whole.on_boundary(v));
    inner_.push_back(std::binary_search(core.begin(), core.end(), v));
    if (boundary_.back())
      fidelity.valences.set(static_cast<Index>(i), whole_fidelity.valences.range(v));
    if (!whole_fidelity.patches.empty())
      fidelity.patches.of_vertex.push_back(whole_fidelity.patches.of_vertex[v]);
  }
  fidelity.patches.of_facet = whole_fidelity.patches.of_facet;
  fidelity.knots = Knots(knots, whole, vertex, inner_, knot_);
  if (fidelity.knots.empty()) return;
  mesh.knot.assign(vertex.size(), -1);
  for (std::size_t i = 0; i < vertex.size(); ++i)
    if (const Index k = whole.knot[vertex[i]]; k >= 0)
      mesh.knot[i] =
          static_cast<Index>(std::lower_bound(knot_.begin(), knot_.end(), k) - knot_.begin());
}

Index Patch::local(Index v) const {
  return static_cast<Index>(std::lower_bound(vertex.begin(), vertex.end(), v) - vertex.begin());
}

int Patch::total_defect() const {
  int sum = 0;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v)) sum += defect(v);
  return sum;
}

bool Patch::possible(const Edit& edit) const {
  // A patch of a closed mesh may hold an edge of two border vertices twice over; and the ring of a
  // border vertex is not known: one inner end makes the new edge's existence decidable.
  if (edit.kind == Edit::Kind::CollapseCurve || edit.kind == Edit::Kind::SplitCurve) {
    if (!inner_knot(edit.a) || !inner_knot(edit.b)) return false;
  } else if (edit.kind == Edit::Kind::Collapse) {
    if (!inner(edit.a) || !inner(edit.b)) return false;
  } else if (!inner(edit.a) && !inner(edit.b)) {
    return false;
  }
  if (edit.kind == Edit::Kind::Flip) {
    const mesh::Edge e = mesh.find_edge(edit.a, edit.b);
    const mesh::Edge o = e.valid() ? mesh.twin(e) : mesh::Edge{};
    if (!o.valid()) return false;
    if (!inner(mesh.opposite_vertex(e)) && !inner(mesh.opposite_vertex(o))) return false;
    if (valence(edit.a) <= 3 || valence(edit.b) <= 3) return false;
  }
  return edit_possible(mesh, fidelity.knots, edit);
}

// Whether the patch knows all copies of v's knot and all that is around them.
bool Patch::inner_knot(Index v) const {
  const Index k = mesh.knot.empty() ? -1 : mesh.knot[v];
  if (k < 0) return false;
  if (fidelity.knots.all[k].slides) return true;
  const std::vector<Index>& copies = fidelity.knots.all[k].copies;
  return std::all_of(copies.begin(), copies.end(), [&](Index c) { return inner(c); });
}

void Patch::remember(const Edit& edit, const std::vector<Index>& made) {
  edits.push_back(edit);
  for (std::size_t i = 0; i < made.size(); ++i) {
    vertex.push_back(-1);
    hidden_.push_back(0);
    boundary_.push_back(edit.kind == Edit::Kind::SplitCurve);
    inner_.push_back(1);
  }
  if (edit.kind == Edit::Kind::SplitCurve) knot_.push_back(-1);
}

void Patch::apply(const Edit& edit) {
  const std::vector<Index> made = apply_edit(mesh, fidelity.knots, edit);
  if (edit.kind == Edit::Kind::SplitCurve)
    for (const Index m : made) fidelity.valences.measure(mesh, m);
  remember(edit, made);
}

void Patch::apply_with_samples(const Edit& edit) {
  remember(edit, apply_edit(mesh, fidelity, edit));
}

std::vector<Index> Patch::inner_vertices() const {
  std::vector<Index> list;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && inner(v) && (!boundary(v) || fidelity.knots.sliding(mesh, v) >= 0))
      list.push_back(v);
  return list;
}

PatchScore Patch::score(const energy::ShapeWeights& shape, const AngleTest& promise,
                        const AngleTest& goal) const {
  PatchScore score;
  score.bad_valence = total_defect();
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    const std::array<Vec3, 3> p = corners(mesh, t);
    score.folded += is_folded(mesh, fidelity, t);
    score.outside_promise += !promise.inside(p[0], p[1], p[2]);
    score.outside_goal += !goal.inside(p[0], p[1], p[2]);
    score.energy +=
        fidelity.size.shape(mesh.triangle(t), p, shape) + fidelity.triangle(t, p, nullptr);
  }
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v)) score.energy += fidelity.vertex(v, mesh.positions[v], nullptr);
  return score;
}

std::vector<Index> Patch::commit(mesh::EditableMesh& whole, Fidelity& whole_fidelity) {
  Index next_made = 0;
  while (next_made < static_cast<Index>(vertex.size()) && vertex[next_made] >= 0) ++next_made;
  std::size_t next_knot = 0;
  while (next_knot < knot_.size() && knot_[next_knot] >= 0) ++next_knot;
  for (const Edit& edit : edits) {
    for (const Index made :
         apply_edit(whole, whole_fidelity, {edit.kind, vertex[edit.a], vertex[edit.b]}))
      vertex[next_made++] = made;
    if (edit.kind == Edit::Kind::SplitCurve)
      knot_[next_knot++] = static_cast<Index>(whole_fidelity.knots.all.size()) - 1;
  }
  for (std::size_t k = 0; k < knot_.size(); ++k)
    if (fidelity.knots.all[k].slides)
      whole_fidelity.knots.all[knot_[k]].place.arc = fidelity.knots.all[k].place.arc;
  std::vector<Index> touched;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v) {
    if (!mesh.alive_vertex(v) || !inner(v)) continue;
    whole.positions[vertex[v]] = mesh.positions[v];
    for_ring(whole, vertex[v], [&](Index t, int) { touched.push_back(t); });
  }
  sort_unique(touched);
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && inner(v)) whole_fidelity.update_vertex(whole, vertex[v]);
  whole_fidelity.rewalk(whole, touched);
  return touched;
}

}  // namespace nonobtuse::refine
