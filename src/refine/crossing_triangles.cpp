// Segment against triangle by the signs of tetrahedra (Moeller & Trumbore 1997 in spirit): two
// triangles cross where an edge of one passes through the other.
#include "refine/crossing_triangles.h"

#include <algorithm>

#include "refine/fidelity.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::refine {
namespace {

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

// Triangles that share points, if only copies of a knot: only an edge away from all of these can
// pass through the other, in exact arithmetic and so here.
bool cross_beside_shared(const Corners& a, const Triangle& of_a, const Corners& b,
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

bool properly_cross(const mesh::EditableMesh& mesh, const Knots& knots, Index t, Index u) {
  const Triangle& v = mesh.triangle(t);
  const Triangle& w = mesh.triangle(u);
  const Corners a = corners(mesh, t), b = corners(mesh, u);
  // Neighbours are in each other's box: without a fold they cannot cross.
  if (share_vertex(v, w) && dot(area_vector(a), area_vector(b)) >= 0) return false;
  const auto glued = [&](const Triangle& x) -> Triangle {
    return {knots.representative(mesh, x[0]), knots.representative(mesh, x[1]),
            knots.representative(mesh, x[2])};
  };
  const Triangle glued_v = glued(v), glued_w = glued(w);
  return share_vertex(glued_v, glued_w) ? cross_beside_shared(a, glued_v, b, glued_w)
                                        : cross_each_other(a, b);
}

std::vector<std::pair<Index, Index>> crossing_triangles(const mesh::EditableMesh& mesh,
                                                        const Knots& knots,
                                                        const parallel::Workers& workers) {
  std::vector<Triangle> triangles;
  std::vector<Index> old;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t)) triangles.push_back(mesh.triangle(t)), old.push_back(t);
  const spatial::TriangleBvh bvh(mesh.positions, triangles, workers);
  std::vector<std::vector<Index>> found(triangles.size());
  workers.for_each(triangles.size(), 256, [&](std::size_t i) {
    spatial::Box box;
    for (const Vec3& p : corners(mesh, old[i])) box.add(p);
    bvh.for_overlapping(box, [&](Index j) {
      if (j > static_cast<Index>(i) && properly_cross(mesh, knots, old[i], old[j]))
        found[i].push_back(j);
    });
    std::sort(found[i].begin(), found[i].end());
  });
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (Index j : found[i]) pairs.emplace_back(old[i], old[j]);
  return pairs;
}

}  // namespace nonobtuse::refine
