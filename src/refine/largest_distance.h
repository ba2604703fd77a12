// The largest two-sided distance between mesh and surface, as Metro measures it: to what is nearest
// at all. Only points whose own foot is far are looked at twice.
#pragma once

#include <vector>

#include "refine/fidelity.h"

namespace nonobtuse::refine {

/// A point of either side that is far from the other.
struct FarPoint {
  double distance;
  Index triangle;  ///< of the mesh
};

/// The weights of a fidelity by number: of the samples, the vertices' planes, the edges' planes.
inline std::size_t weight_count(const Fidelity& f) {
  return f.samples.size() + f.vertex_planes.size() + 3 * f.edge_planes.size();
}
double& weight(Fidelity& fidelity, std::size_t number);

/// A weight of the fidelity, and how far what it pulls at is.
struct FarWeight {
  double distance;
  std::size_t weight;
};

/// The points of a patch farther than `far`: its samples from what is nearest of it, its vertices,
/// points on edges and centroids from the surface. Edges are looked at less closely than by
/// `largest_distance`.
std::vector<FarWeight> far_weights(const mesh::EditableMesh& patch, const Fidelity& fidelity,
                                   double far);

/// The largest distance of these; `far` if there are none.
double largest_distance(const mesh::EditableMesh& patch, const Fidelity& fidelity, double far);

/// Triangles with points farther than a bound, each with its largest distance, while the mesh
/// changes here and there.
class FarPoints {
 public:
  /// Mesh and fidelity must outlive this.
  FarPoints(const mesh::EditableMesh& mesh, const Fidelity& fidelity, double far,
            const parallel::Workers& workers);
  /// After a change of these triangles and of the samples of triangles around them.
  void update(const std::vector<Index>& changed, const std::vector<Index>& around,
              const parallel::Workers& workers);
  /// The farthest first.
  [[nodiscard]] const std::vector<FarPoint>& list() const { return list_; }
  /// Squared distance of a point from the mesh, if less than `limit`, else that.
  [[nodiscard]] double squared_distance(const Vec3& p, double limit) const;

 private:
  void sort();

  const mesh::EditableMesh* mesh_;
  const Fidelity* fidelity_;
  double far_;
  spatial::TriangleBvh bvh_;     // of the mesh as it was
  std::vector<Index> triangle_;  // of the hierarchy's triangles
  std::vector<char> is_changed_;
  std::vector<Index> changed_;
  std::vector<FarPoint> list_;
};

}  // namespace nonobtuse::refine
