// Segment against triangle by the signs of tetrahedra (Moeller & Trumbore 1997 in spirit): two
// triangles cross where an edge of one passes through the other.
#include "refine/sheet_separation.h"

#include <algorithm>
#include <cmath>

#include "refine/neighborhood.h"
#include "refine/relaxation.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 8;
constexpr double kPush = 0.04;  // outwards per round, where the size is 1
constexpr double kEmphasis = 2;

using Corners = std::array<Vec3, 3>;

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(b - a, c - a), d - a);
}

bool passes_through(const Vec3& a, const Vec3& b, const Corners& t) {
  if (!(volume(t[0], t[1], t[2], a) * volume(t[0], t[1], t[2], b) < 0)) return false;
  const double u = volume(a, b, t[0], t[1]), v = volume(a, b, t[1], t[2]),
               w = volume(a, b, t[2], t[0]);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

bool cross_each_other(const Corners& a, const Corners& b) {
  for (int k = 0; k < 3; ++k)
    if (passes_through(a[k], a[mesh::next(k)], b) || passes_through(b[k], b[mesh::next(k)], a))
      return true;
  return false;
}

// Triangles of two sectors that touch at copies of a knot: only an edge away from all shared
// points can pass through the other, in exact arithmetic and so here.
bool cross_beside_knots(const Corners& a, const Triangle& of_a, const Corners& b,
                        const Triangle& of_b) {
  const auto passes = [](const Corners& p, const Triangle& own, const Corners& q,
                         const Triangle& other) {
    const auto shared = [&](Index v) { return v == other[0] || v == other[1] || v == other[2]; };
    for (int k = 0; k < 3; ++k)
      if (!shared(own[k]) && !shared(own[mesh::next(k)]) &&
          passes_through(p[k], p[mesh::next(k)], q))
        return true;
    return false;
  };
  return passes(a, of_a, b, of_b) || passes(b, of_b, a, of_a);
}

bool share_vertex(const Triangle& a, const Triangle& b) {
  for (Index v : a)
    if (v == b[0] || v == b[1] || v == b[2]) return true;
  return false;
}

}  // namespace

std::vector<std::pair<Index, Index>> crossing_triangles(const mesh::EditableMesh& mesh,
                                                        const Knots& knots,
                                                        const parallel::Workers& workers) {
  std::vector<Triangle> triangles;
  std::vector<Index> old;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t)) triangles.push_back(mesh.triangle(t)), old.push_back(t);
  std::vector<Triangle> glued = triangles;
  for (Triangle& t : glued)
    for (Index& v : t) v = knots.representative(mesh, v);
  const spatial::TriangleBvh bvh(mesh.positions, triangles, workers);
  std::vector<std::vector<Index>> found(triangles.size());
  workers.for_each(triangles.size(), 256, [&](std::size_t i) {
    const Corners a = corners(mesh, old[i]);
    spatial::Box box;
    for (const Vec3& p : a) box.add(p);
    bvh.for_overlapping(box, [&](Index j) {
      // Neighbours are in each other's box: without a fold they cannot cross.
      if (j <= static_cast<Index>(i)) return;
      const Corners b = corners(mesh, old[j]);
      if (share_vertex(triangles[i], triangles[j]) && dot(area_vector(a), area_vector(b)) >= 0)
        return;
      const Triangle& glued_a = glued[i];
      const Triangle& glued_b = glued[j];
      const bool beside_knots =
          !share_vertex(triangles[i], triangles[j]) && share_vertex(glued_a, glued_b);
      if (beside_knots ? cross_beside_knots(a, glued_a, b, glued_b) : cross_each_other(a, b))
        found[i].push_back(j);
    });
    std::sort(found[i].begin(), found[i].end());
  });
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (Index j : found[i]) pairs.emplace_back(old[i], old[j]);
  return pairs;
}

Index separate_sheets(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                      const parallel::Workers& workers,
                      const std::function<bool(double)>& keep_going) {
  const AngleTest goal(options.goal);
  std::vector<std::pair<Index, Index>> pairs = crossing_triangles(mesh, fidelity.knots, workers);
  if (pairs.empty()) return 0;
  const std::size_t outside = triangles_outside(mesh, goal).size();
  std::size_t least = pairs.size();
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int round = 0; round < kRounds && !pairs.empty(); ++round) {
    if (!keep_going(static_cast<double>(round) / kRounds)) break;
    std::vector<Index> places;
    for (const auto& [a, b] : pairs) places.push_back(a), places.push_back(b);
    sort_unique(places);
    for (Index t : places) {
      for (TangentPlane& plane : fidelity.edge_planes[t])
        plane.push_out(kPush * std::sqrt(fidelity.size.area(mesh.triangle(t))), kEmphasis);
      fidelity.update_triangle(mesh, t);
    }
    for (Index v : dilated(mesh, places, 0)) {
      fidelity.vertex_planes[v].push_out(kPush * fidelity.size.at(v), kEmphasis);
      fidelity.update_vertex(mesh, v);
    }
    std::vector<Index> active = dilated(mesh, places, 2);
    fidelity.knots.add_copies(mesh, active);
    relax(mesh, fidelity, active, {options.shape, 6, options.on_surface}, workers);
    fidelity.rewalk(mesh, triangles_around(mesh, active));
    pairs = crossing_triangles(mesh, fidelity.knots, workers);
    if (pairs.size() >= least || triangles_outside(mesh, goal).size() > outside) continue;
    least = pairs.size();
    best_mesh = mesh;
    best_fidelity = fidelity;
  }
  mesh = std::move(best_mesh);
  fidelity = std::move(best_fidelity);
  return static_cast<Index>(least);
}

}  // namespace nonobtuse::refine
