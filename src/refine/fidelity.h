// Two-sided distance between the surface M and the mesh T as an energy: area-uniform samples of M
// against their nearest triangles of T, vertices and edge midpoints of T against tangent planes of
// M. Which triangle and which plane is frozen between updates; the closest point on the triangle is
// not, so the gradient is exact by the envelope theorem. A sample only looks at triangles whose
// normal agrees with its own facet's, and a foot only at such facets: the two sheets of a thin
// part never see each other.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/workers.h"
#include "refine/knots.h"
#include "refine/surface_patches.h"
#include "refine/target_size.h"
#include "refine/triangle_frame.h"
#include "refine/valence_rule.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::refine {

/// A point of M that T should pass through.
struct Sample {
  Vec3 point;
  double weight = 0;  ///< area it stands for
  Index facet = -1;   ///< of M
  Index ridge = -1;   ///< number among the points of M's vertices and edges, if it is one
  Index next = -1;    ///< next sample of the same triangle of T, -1 at the end
};

/// Tangent plane of M under a point of T.
struct TangentPlane {
  double emphasis = 1;  ///< factor of the weight, see emphasize_far_points
  double offset = 0;    ///< distance at which the point should lie, outwards
  Vec3 point;           ///< foot of the point
  Vec3 normal;          ///< unit, outwards: the facet's, or the offset's direction at sharp places
  Index facet = -1;

  void push_out(double by, double factor) { offset += by, emphasis *= factor; }
  /// Takes over foot, normal and facet, but not emphasis and offset.
  void move_to(const TangentPlane& other) {
    point = other.point, normal = other.normal, facet = other.facet;
  }
};

/// Planes under the midpoints of a triangle's edges, edge k opposite corner k. An edge that cuts
/// across a valley shows at its middle, not at the triangle's centroid.
using EdgePlanes = std::array<TangentPlane, 3>;

struct FidelityWeights {
  double to_mesh = 10;     ///< M -> T
  double to_surface = 10;  ///< T -> M
};

/// `count` samples of M, uniform by area (with sizing: by the density of sites), in the order of
/// the facets; each stands for the same share of it. Deterministic.
std::vector<Sample> sample_surface(const mesh::Surface& surface, Index count);

class Fidelity {
 public:
  /// Both must outlive this object.
  Fidelity(const mesh::Surface& of, const spatial::TriangleBvh& bvh_of)
      : surface_(&of), surface_bvh_(&bvh_of) {}

  [[nodiscard]] const mesh::Surface& surface() const { return *surface_; }
  [[nodiscard]] const spatial::TriangleBvh& surface_bvh() const { return *surface_bvh_; }

  FidelityWeights weights;
  /// Distance from the tangent plane, where the size is 1, beyond which vertices are drawn back
  /// so strongly that angles near the bounds give way first.
  double leash = std::numeric_limits<double>::infinity();
  TargetSize size;       ///< frozen; before samples and planes
  PatchLabels patches;   ///< before samples and planes; empty: anything may be near anything
  Knots knots;           ///< empty: no vertex is on a curve that it may slide along
  ValenceRule valences;  ///< of the mesh's boundary vertices
  std::vector<Sample> samples;
  std::vector<Index> first;                 ///< #T, head of each triangle's list of samples
  std::vector<TangentPlane> vertex_planes;  ///< #V
  std::vector<EdgePlanes> edge_planes;      ///< #T by 3
  std::vector<double> vertex_weights;       ///< #V, frozen: ring area / 12
  std::vector<double> edge_weights;         ///< #T, frozen: a quarter of the area for each edge

  /// Before anything else on a mesh with boundary: measures the sectors' angles; with `curves`
  /// (and a mesh with knots) takes over the knots and finds which patches belong together. The
  /// curves must outlive this object.
  void attach_curves(const mesh::EditableMesh& mesh, const mesh::CurveNetwork* curves,
                     const parallel::Workers& workers);
  /// Gives every sample to the nearest triangle that agrees with it, by search.
  void search_samples(const mesh::EditableMesh& mesh, const parallel::Workers& workers);
  /// The same by walking over the mesh from the present triangle to nearer neighbours; sorts the
  /// samples by triangle.
  void walk_samples(const mesh::EditableMesh& mesh, const parallel::Workers& workers);
  /// The same for the samples of a few triangles, unsorted; renews these triangles' planes.
  /// Returns the triangles that got samples of others.
  std::vector<Index> rewalk(const mesh::EditableMesh& mesh, std::span<const Index> triangles);
  /// Points of T that stick out: multiplies by `growth` the weights of vertices and midpoints
  /// farther than `far` from their tangent planes.
  void emphasize_far_points(const mesh::EditableMesh& mesh, double far, double growth);
  /// Vertices and sharp edges of M, which samples by area miss: adds points of them farther than
  /// `far` from T as samples of the given weight; of those added before, multiplies the weights by
  /// `growth` where they are still far. With `triangles`, only where the samples of these lie.
  /// Returns how many are far.
  Index emphasize_far_ridges(const mesh::EditableMesh& mesh, double far, double weight,
                             double growth, const parallel::Workers& workers,
                             const std::vector<Index>* triangles = nullptr);
  /// Gives the samples of these triangles to the nearest of them (after a local edit).
  void redistribute(const mesh::EditableMesh& mesh, std::span<const Index> triangles);
  /// Feet, tangent planes and weights of all vertices and midpoints: by search where there is none
  /// yet or with `search`, else by walking over M.
  void update_planes(const mesh::EditableMesh& mesh, const parallel::Workers& workers,
                     bool search = false);
  /// The same for one vertex or one triangle.
  void update_vertex(const mesh::EditableMesh& mesh, Index vertex, bool search = false);
  void update_triangle(const mesh::EditableMesh& mesh, Index triangle, bool search = false);

  /// Energy of the samples and the edges of a triangle with corners p; adds to `gradient`.
  double triangle(Index t, const std::array<Vec3, 3>& p, std::array<Vec3, 3>* gradient) const;
  /// Energy of the samples and the edges of a triangle; adds to the gradient by corner k and, with
  /// feet and closest points frozen (Gauss-Newton), to the Hessian's columns.
  double corner(Index t, const std::array<Vec3, 3>& p, int k, Vec3& gradient,
                std::array<Vec3, 3>& hessian) const;
  /// Energy of a vertex at p against its tangent plane; adds to `gradient`.
  double vertex(Index v, const Vec3& p, Vec3* gradient) const;
  /// `to` for vertex v at `from`, brought back along the normal to twice the leash from the tangent
  /// plane, or to as far as it is now: no weight of the angles can pull it farther.
  Vec3 on_leash(Index v, const Vec3& from, const Vec3& to) const;
  /// Second derivative of that energy along the plane's normal.
  double vertex_stiffness(Index v, const Vec3& p) const;
  /// Mean squared distance of the samples, by weight.
  [[nodiscard]] double mean_square(const mesh::EditableMesh& mesh) const;

  /// Foot of p on M on the side that `normal` looks to, by search within `reach`, if there
  /// is such a side; else the nearest point.
  /// With `vertex` >= 0 only on the patch of the surface that this vertex of T belongs to.
  [[nodiscard]] TangentPlane search_foot(const Vec3& p, const Vec3& normal, double reach,
                                         Index vertex = -1) const;
  /// Foot of p on M by walking over the facets from `facet`.
  [[nodiscard]] TangentPlane walk_foot(const Vec3& p, Index facet) const;

 private:
  const mesh::Surface* surface_;
  const spatial::TriangleBvh* surface_bvh_;

  [[nodiscard]] Index walk_to_nearest(const mesh::EditableMesh& mesh, Index from,
                                      const Sample& sample, ClosestPoint& nearest) const;
  [[nodiscard]] double leash_stiffness(Index v) const;
  void sort_samples(const std::vector<Index>& triangle_of_sample, Index triangles);
  [[nodiscard]] TangentPlane plane(const Vec3& p, const Vec3& foot, Index facet) const;
};

/// Middle of the edge opposite corner k.
inline Vec3 midpoint(const std::array<Vec3, 3>& p, int k) {
  return 0.5 * (p[mesh::next(k)] + p[mesh::previous(k)]);
}

/// Corner positions of a triangle.
inline std::array<Vec3, 3> corners(const mesh::EditableMesh& mesh, Index t) {
  const Triangle& v = mesh.triangle(t);
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Twice the area times the normal.
inline Vec3 area_vector(const std::array<Vec3, 3>& p) { return area_vector(p[0], p[1], p[2]); }

/// Sum of the area vectors around a vertex.
Vec3 vertex_area_vector(const mesh::EditableMesh& mesh, Index v);

/// Calls visit(triangle, corner) for the triangles around v, without allocation.
template <class Visit>
void for_ring(const mesh::EditableMesh& mesh, Index v, const Visit& visit) {
  const Index start = mesh.triangle_of(v);
  Index t = start;
  do {
    const int k = mesh.corner_of(t, v);
    visit(t, k);
    t = mesh.adjacent(t, mesh::next(k));
  } while (t >= 0 && t != start);
}

}  // namespace nonobtuse::refine
