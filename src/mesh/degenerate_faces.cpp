// Botsch & Kobbelt, A Robust Procedure to Eliminate Degenerate Faces from Triangle Meshes, 2001:
// needles are collapsed, caps flipped. Here both words mean exactly no area.
#include "mesh/degenerate_faces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/cut.h"
#include "mesh/editable_mesh.h"
#include "mesh/topology.h"
#include "numeric/expansion.h"
#include "numeric/vec3.h"

namespace nonobtuse::mesh {

namespace {

double largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

Vec3 scaled(const Vec3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

// Corner of the point between the other two on their line; -1 if two of the points coincide.
int middle_corner(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (a == b || b == c || c == a) return -1;
  // Distinct points of a line are ordered alike by every coordinate in which they differ at all.
  const auto between = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    const auto in = [](double x, double y, double z) {
      return (y <= x && x <= z) || (z <= x && x <= y);
    };
    return in(p.x, q.x, r.x) && in(p.y, q.y, r.y) && in(p.z, q.z, r.z);
  };
  if (between(a, b, c)) return 0;
  return between(b, c, a) ? 1 : 2;
}

class Remover {
 public:
  explicit Remover(const TriangleMesh& mesh) : mesh_(mesh.vertices, mesh.triangles) {}

  /// Edits until no face without area can be edited away.
  void run(DegenerateRemoval& counts) {
    find_all();
    // Each flip shortens the longest edges and each collapse removes a vertex, so this ends.
    while (!pending_.empty()) {
      std::vector<Index> todo;
      todo.swap(pending_);
      std::sort(todo.begin(), todo.end());
      todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
      const std::size_t edits = edits_;
      for (const Index t : todo)
        if (is_degenerate(t) && !edit(t, false, counts)) pending_.push_back(t);
      if (edits_ != edits) continue;
      // Stuck: contract a needle along its shorter side instead, unless it may be dropped.
      for (const Index t : pending_)
        if (is_degenerate(t) && !may_be_dropped(t) && edit(t, true, counts)) break;
      if (edits_ == edits) break;
    }
  }

  /// Drops those left whose longest edge is at the boundary, or all if there are no such; true if
  /// any was dropped. Dropping one may bring the next to the boundary, so call again.
  bool drop(TriangleMesh& mesh, DegenerateRemoval& counts) {
    std::vector<char> dropped(mesh_.triangle_capacity(), 0);
    Index at_boundary = 0;
    Index left = 0;
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) {
      if (!is_degenerate(t)) continue;
      const bool boundary = may_be_dropped(t);
      dropped[t] = boundary ? 2 : 1;
      ++(boundary ? at_boundary : left);
    }
    const char least = at_boundary > 0 ? 2 : 1;
    mesh.triangles.clear();
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
      if (mesh_.alive_triangle(t) && dropped[t] < least)
        mesh.triangles.push_back(mesh_.triangle(t));
    counts.dropped += at_boundary > 0 ? at_boundary : left;
    if (at_boundary == 0) counts.opened += left;
    return at_boundary + left > 0;
  }

 private:
  [[nodiscard]] const Vec3& point(Index t, int k) const {
    return mesh_.positions[mesh_.triangle(t)[k]];
  }
  [[nodiscard]] bool is_degenerate(Index t) const {
    return mesh_.alive_triangle(t) && collinear(point(t, 0), point(t, 1), point(t, 2));
  }
  [[nodiscard]] int corner_between(Index t) const {
    return middle_corner(point(t, 0), point(t, 1), point(t, 2));
  }

  // Whether its longest edge is at the boundary, so that the surface does not miss it.
  [[nodiscard]] bool may_be_dropped(Index t) const {
    const int k = corner_between(t);
    return k >= 0 && mesh_.adjacent(t, k) < 0;
  }

  void find_all() {
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
      if (is_degenerate(t)) pending_.push_back(t);
  }

  bool edit(Index t, bool contract_needles, DegenerateRemoval& counts) {
    const int k = corner_between(t);
    if (k < 0) return merge_coincident(t, counts);
    if (contract_needles) {
      const double to_next = distance(point(t, k), point(t, next(k)));
      const double to_previous = distance(point(t, k), point(t, previous(k)));
      const int shorter = to_next <= to_previous ? previous(k) : next(k);
      return collapse({t, shorter}, mesh_.triangle(t)[k], counts) ||
             collapse({t, shorter == next(k) ? previous(k) : next(k)}, mesh_.triangle(t)[k],
                      counts);
    }
    const Edge longest{t, k};
    const Index other = mesh_.adjacent(t, k);
    if (other < 0 || !mesh_.can_flip(longest)) return false;
    // A needle next to it goes first unless the edge is the longest of both: no flip then makes a
    // longer needle than there was.
    if (is_degenerate(other) && corner_between(other) != mesh_.twin(longest).corner) return false;
    mesh_.flip(longest);
    pending_.push_back(t);
    pending_.push_back(other);
    ++edits_;
    ++counts.flipped;
    return true;
  }

  bool merge_coincident(Index t, DegenerateRemoval& counts) {
    for (int k = 0; k < 3; ++k) {
      if (!(point(t, next(k)) == point(t, previous(k)))) continue;
      const Edge e{t, k};
      const Index later = std::max(mesh_.tail(e), mesh_.head(e));
      const Index earlier = std::min(mesh_.tail(e), mesh_.head(e));
      if (collapse(e, later, counts) || collapse(e, earlier, counts)) return true;
    }
    return false;
  }

  bool collapse(Edge e, Index removed, DegenerateRemoval& counts) {
    if (!mesh_.can_collapse(e, removed)) return false;
    const Index kept = mesh_.tail(e) == removed ? mesh_.head(e) : mesh_.tail(e);
    mesh_.collapse(e, removed);
    std::vector<Index> around;
    mesh_.triangles_around(kept, around);
    pending_.insert(pending_.end(), around.begin(), around.end());
    ++edits_;
    ++counts.collapsed;
    return true;
  }

  EditableMesh mesh_;
  std::vector<Index> pending_;
  std::size_t edits_ = 0;
};

// A component of the area vector that is far from zero for its rounding errors, in coordinates of
// usual size; most triangles have one.
bool clearly_has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const auto clear = [](double p, double q) {
    const double magnitude = std::abs(p) + std::abs(q);
    return magnitude > 1e-280 && std::abs(p - q) > 1e-14 * magnitude;
  };
  return clear(u.x * v.y, u.y * v.x) || clear(u.y * v.z, u.z * v.y) || clear(u.z * v.x, u.x * v.z);
}

}  // namespace

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (clearly_has_area(a, b, c)) return false;
  int exponent = 0;
  std::frexp(std::max({largest_coordinate(a), largest_coordinate(b), largest_coordinate(c)}),
             &exponent);
  exponent -= 500;  // high enough that small differences do not underflow, squares below overflow
  const Vec3 p = scaled(a, -exponent);
  const Vec3 q = scaled(b, -exponent);
  const Vec3 r = scaled(c, -exponent);
  // Filter: a component of the area vector beyond its rounding error (each product's factors carry
  // one rounding each, plus the product's and the sum's; underflow costs less than 1e-300).
  const Vec3 u = q - p;
  const Vec3 v = r - p;
  const auto clear = [](double u1, double v2, double u2, double v1) {
    const double left = u1 * v2;
    const double right = u2 * v1;
    return std::abs(left - right) > 1e-15 * (std::abs(left) + std::abs(right)) + 1e-300;
  };
  if (clear(u.x, v.y, u.y, v.x) || clear(u.y, v.z, u.z, v.y) || clear(u.z, v.x, u.x, v.z))
    return false;
  using numeric::Expansion;
  const auto minor = [](double p1, double q1, double r1, double p2, double q2, double r2) {
    return (Expansion::difference(q1, p1) * Expansion::difference(r2, p2) -
            Expansion::difference(q2, p2) * Expansion::difference(r1, p1))
        .sign();
  };
  return minor(p.x, q.x, r.x, p.y, q.y, r.y) == 0 && minor(p.y, q.y, r.y, p.z, q.z, r.z) == 0 &&
         minor(p.z, q.z, r.z, p.x, q.x, r.x) == 0;
}

DegenerateRemoval remove_degenerate_faces(TriangleMesh& mesh) {
  DegenerateRemoval counts;
  // Dropping a needle at the boundary may bring the next one there.
  for (bool again = true; again && !mesh.triangles.empty();) {
    Remover remover(mesh);
    remover.run(counts);
    again = remover.drop(mesh, counts);
    const auto count = static_cast<Index>(mesh.vertices.size());
    if (again &&
        cut_to_manifold(mesh.triangles, count, edge_sides(mesh.triangles, count)).original.size() >
            mesh.vertices.size())
      break;  // no longer a manifold: the caller's check says so
  }
  return counts;
}

}  // namespace nonobtuse::mesh
