// Triangle against triangle by signs of orientations alone (after Guigue & Devillers, Fast and
// Robust Triangle-Triangle Overlap Test Using Orientation Predicates, 2003), each sign exact.
// Two triangles meet if and only if an edge of one meets the other; with a shared corner, if and
// only if the edge opposite of it does.
#include "quality/self_intersections.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "nonobtuse/context.h"
#include "nonobtuse/quality.h"
#include "numeric/predicates.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "quality/validity.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse {

namespace quality {

namespace {

using numeric::orient2d;
using numeric::orient3d;
using numeric::Vec2;
using numeric::without;

// An axis along which the points do not project to a line; -1 if they lie on a line in space.
int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orient2d(without(axis, a), without(axis, b), without(axis, c)) != 0) return axis;
  return -1;
}

bool boxes_meet(const Vec2& a, const Vec2& b, const Vec2& p, const Vec2& q) {
  return std::max(std::min(a.x, b.x), std::min(p.x, q.x)) <=
             std::min(std::max(a.x, b.x), std::max(p.x, q.x)) &&
         std::max(std::min(a.y, b.y), std::min(p.y, q.y)) <=
             std::min(std::max(a.y, b.y), std::max(p.y, q.y));
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& p, const Vec2& q) {
  return boxes_meet(a, b, p, q) && orient2d(a, b, p) * orient2d(a, b, q) <= 0 &&
         orient2d(p, q, a) * orient2d(p, q, b) <= 0;
}

bool segments_meet(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
  if (orient3d(a, b, p, q) != 0) return false;
  int axis = projection_axis(a, b, p);
  if (axis < 0) axis = projection_axis(a, b, q);
  if (axis < 0) axis = projection_axis(p, q, a);
  if (axis < 0) axis = projection_axis(p, q, b);
  if (axis >= 0)
    return segments_meet(without(axis, a), without(axis, b), without(axis, p), without(axis, q));
  // All on one line: where the boxes meet along every axis.
  return boxes_meet(without(0, a), without(0, b), without(0, p), without(0, q)) &&
         boxes_meet(without(1, a), without(1, b), without(1, p), without(1, q));
}

bool inside(const Vec2& p, const std::array<Vec2, 3>& t) {
  const int u = orient2d(t[0], t[1], p);
  const int v = orient2d(t[1], t[2], p);
  const int w = orient2d(t[2], t[0], p);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

bool coplanar_segment_meets_triangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const int axis = projection_axis(t[0], t[1], t[2]);
  if (axis < 0)  // the longest of three sides on a line covers the others
    return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) ||
           segments_meet(p, q, t[2], t[0]);
  const Vec2 from = without(axis, p);
  const Vec2 to = without(axis, q);
  const std::array<Vec2, 3> f{without(axis, t[0]), without(axis, t[1]), without(axis, t[2])};
  return inside(from, f) || segments_meet(from, to, f[0], f[1]) ||
         segments_meet(from, to, f[1], f[2]) || segments_meet(from, to, f[2], f[0]);
}

// The same with the sides of the triangle's plane on which p and q lie.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, int side_p, int side_q,
                            const std::array<Vec3, 3>& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_segment_meets_triangle(p, q, t);
  const int u = orient3d(p, q, t[0], t[1]);
  const int v = orient3d(p, q, t[1], t[2]);
  if (u * v < 0) return false;
  const int w = orient3d(p, q, t[2], t[0]);
  return u * w >= 0 && v * w >= 0;
}

using Corners = std::array<Vec3, 3>;

std::array<int, 3> sides_of(const Corners& plane, const Corners& points) {
  const auto side = [&](const Vec3& p) { return orient3d(plane[0], plane[1], plane[2], p); };
  return {side(points[0]), side(points[1]), side(points[2])};
}

bool all_on_one_side(const std::array<int, 3>& s) {
  return s[0] != 0 && s[0] == s[1] && s[1] == s[2];
}

bool disjoint_corners_intersect(const Corners& s, const Corners& t) {
  const std::array<int, 3> s_side = sides_of(t, s);
  if (all_on_one_side(s_side)) return false;
  const std::array<int, 3> t_side = sides_of(s, t);
  if (all_on_one_side(t_side)) return false;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    if (segment_meets_triangle(s[k], s[l], s_side[k], s_side[l], t)) return true;
    if (segment_meets_triangle(t[k], t[l], t_side[k], t_side[l], s)) return true;
  }
  return false;
}

bool has_area(const Corners& t) { return projection_axis(t[0], t[1], t[2]) >= 0; }

// s[0] = t[0] is the one shared corner.
bool intersect_beyond_corner(const Corners& s, const Corners& t) {
  const int t1 = orient3d(s[0], s[1], s[2], t[1]);
  const int t2 = orient3d(s[0], s[1], s[2], t[2]);
  if (t1 * t2 > 0) return false;
  const int s1 = orient3d(t[0], t[1], t[2], s[1]);
  const int s2 = orient3d(t[0], t[1], t[2], s[2]);
  if (s1 * s2 > 0) return false;
  if (!has_area(s) || !has_area(t)) return false;
  return segment_meets_triangle(s[1], s[2], s1, s2, t) ||
         segment_meets_triangle(t[1], t[2], t1, t2, s);
}

// (s[0], s[1]) is the shared edge, t_apex the other triangle's third corner: only a fold in one
// plane overlaps.
bool fold_over_edge(const Corners& s, const Vec3& t_apex) {
  if (orient3d(s[0], s[1], s[2], t_apex) != 0) return false;
  const int axis = projection_axis(s[0], s[1], s[2]);
  if (axis < 0) return false;
  const Vec2 a = without(axis, s[0]);
  const Vec2 b = without(axis, s[1]);
  return orient2d(a, b, without(axis, s[2])) * orient2d(a, b, without(axis, t_apex)) > 0;
}

Corners rotated(const Corners& t, int first) {
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

}  // namespace

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& triangle) {
  return segment_meets_triangle(p, q, orient3d(triangle[0], triangle[1], triangle[2], p),
                                orient3d(triangle[0], triangle[1], triangle[2], q), triangle);
}

bool triangles_intersect(const Corners& s, const Corners& t) {
  int shared = 0;
  int shared_s = 0;  // sums of shared corners' numbers: with two of them, 3 - sum is the apex
  int shared_t = 0;
  for (int k = 0; k < 3; ++k) {
    const auto same = std::find(t.begin(), t.end(), s[k]);
    if (same == t.end()) continue;
    ++shared;
    shared_s += k;
    shared_t += static_cast<int>(same - t.begin());
  }
  if (shared == 0) return disjoint_corners_intersect(s, t);
  if (shared == 1) return intersect_beyond_corner(rotated(s, shared_s), rotated(t, shared_t));
  const auto repeats = [](const Corners& c) {
    return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
  };
  if (repeats(s) || repeats(t)) return false;
  if (shared == 2) return fold_over_edge(rotated(s, (4 - shared_s) % 3), t[3 - shared_t]);
  return has_area(s);
}

}  // namespace quality

namespace {

quality::Corners corners_of(const TriangleMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

}  // namespace

Index count_self_intersections(const TriangleMesh& mesh, const Context& context) {
  quality::require_measurable(mesh);
  const parallel::Workers workers(context.threads);
  const TriangleMesh unit = quality::scaled(mesh, quality::unit_scale(mesh));
  const spatial::TriangleBvh bvh(unit.vertices, unit.triangles, workers);
  return workers.ordered_sum(
      bvh.order().size(), 512, Index{0}, [&](std::size_t begin, std::size_t end) {
        Index count = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Index t = bvh.order()[i];
          const auto corners = corners_of(mesh, t);
          spatial::Box box;
          for (const Index v : unit.triangles[t]) box.add(unit.vertices[v]);
          bvh.for_overlapping(box, [&](Index other) {
            if (other > t && quality::triangles_intersect(corners, corners_of(mesh, other)))
              ++count;
          });
        }
        return count;
      });
}

}  // namespace nonobtuse
