#include "remesh/mesh_subdivision.h"

#include <algorithm>
#include <array>
#include <utility>

#include "refine/fidelity.h"
#include "spatial/hilbert_order.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {
namespace {

struct Points {
  std::vector<Vec3> position;
  std::vector<Index> foot;
};

// Adds the surface's point over the middle of the edge ab, as seen from the nearer end.
Index add_between(const refine::Fidelity& walker, const MeshOnSurface& coarse, Index a, Index b,
                  Points& points) {
  const Vec3 middle = 0.5 * (coarse.mesh.positions[a] + coarse.mesh.positions[b]);
  const refine::TangentPlane p = walker.walk_foot(middle, coarse.foot[a]);
  const refine::TangentPlane q = walker.walk_foot(middle, coarse.foot[b]);
  const bool first = squared_distance(p.point, middle) <= squared_distance(q.point, middle);
  points.position.push_back(first ? p.point : q.point);
  points.foot.push_back(first ? p.facet : q.facet);
  return static_cast<Index>(points.position.size()) - 1;
}

std::vector<Triangle> quartered(const refine::Fidelity& walker, const MeshOnSurface& coarse,
                                Points& points) {
  const mesh::EditableMesh& m = coarse.mesh;
  std::vector<std::array<Index, 3>> middle(m.triangle_capacity());
  for (Index t = 0; t < m.triangle_capacity(); ++t)
    for (int k = 0; k < 3; ++k) {
      const mesh::Edge e{t, k};
      if (m.adjacent(t, k) < t) continue;
      const mesh::Edge o = m.twin(e);
      middle[t][k] = middle[o.triangle][o.corner] =
          add_between(walker, coarse, m.tail(e), m.head(e), points);
    }
  std::vector<Triangle> triangles;
  for (Index t = 0; t < m.triangle_capacity(); ++t) {
    const Triangle& v = m.triangle(t);
    const std::array<Index, 3>& w = middle[t];
    triangles.push_back({v[0], w[2], w[1]});
    triangles.push_back({v[1], w[0], w[2]});
    triangles.push_back({v[2], w[1], w[0]});
    triangles.push_back({w[0], w[1], w[2]});
  }
  return triangles;
}

// Neighbours together in memory.
MeshOnSurface sorted_along_curve(const Points& points, std::vector<Triangle> triangles) {
  MeshOnSurface result;
  std::vector<Index> number(points.position.size());
  std::vector<Vec3> positions;
  for (const Index i : spatial::hilbert_order(points.position)) {
    number[i] = static_cast<Index>(positions.size());
    positions.push_back(points.position[i]);
    result.foot.push_back(points.foot[i]);
  }
  for (Triangle& t : triangles) {
    t = {number[t[0]], number[t[1]], number[t[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(triangles.begin(), triangles.end());
  result.mesh = mesh::EditableMesh(std::move(positions), std::move(triangles));
  return result;
}

// The longest edge, or the shortest that can be contracted.
mesh::Edge extreme_edge(const mesh::EditableMesh& mesh, bool longest) {
  mesh::Edge best;
  double extreme = 0;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    for (int k = 0; k < 3; ++k) {
      if (mesh.adjacent(t, k) < t) continue;
      const mesh::Edge e{t, k};
      const double l2 =
          squared_distance(mesh.positions[mesh.tail(e)], mesh.positions[mesh.head(e)]);
      if (best.valid() && (longest ? l2 <= extreme : l2 >= extreme)) continue;
      if (!longest && !mesh.can_collapse(e, mesh.tail(e))) continue;
      best = e;
      extreme = l2;
    }
  }
  return best;
}

void reach_count(const refine::Fidelity& walker, Index count, MeshOnSurface& t) {
  while (t.mesh.vertex_count() != count) {
    const bool more = t.mesh.vertex_count() < count;
    const mesh::Edge e = extreme_edge(t.mesh, more);
    if (!e.valid()) break;
    const Index a = t.mesh.tail(e), b = t.mesh.head(e);
    if (!more) {
      t.mesh.collapse(e, a);
      continue;
    }
    const Vec3 middle = 0.5 * (t.mesh.positions[a] + t.mesh.positions[b]);
    const refine::TangentPlane plane = walker.walk_foot(middle, t.foot[a]);
    t.mesh.split_edge(e, plane.point);
    t.foot.push_back(plane.facet);
  }
  if (t.mesh.vertex_capacity() == t.mesh.vertex_count()) return;
  std::vector<Index> foot;
  for (const Index v : t.mesh.compact()) foot.push_back(t.foot[v]);
  t.foot = std::move(foot);
}

}  // namespace

MeshOnSurface subdivided(const mesh::Surface& surface, const MeshOnSurface& coarse, Index count) {
  const spatial::TriangleBvh none;
  const refine::Fidelity walker(surface, none);
  Points points{coarse.mesh.positions, coarse.foot};
  std::vector<Triangle> triangles = quartered(walker, coarse, points);
  MeshOnSurface fine = sorted_along_curve(points, std::move(triangles));
  reach_count(walker, count, fine);
  return fine;
}

}  // namespace nonobtuse::pipeline
