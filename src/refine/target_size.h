// What refinement knows of sizing: a frozen target size at every vertex of the mesh. Shapes are
// judged in units of it, so that a triangle counts the same wherever it lies, and step lengths and
// search radii follow it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"

namespace nonobtuse::refine {

class TargetSize {
 public:
  /// #V: size relative to a uniform mesh; empty: uniform, and nothing below costs anything.
  std::vector<double> of_vertex;

  [[nodiscard]] bool uniform() const { return of_vertex.empty(); }
  [[nodiscard]] double at(Index v) const { return uniform() ? 1 : of_vertex[v]; }
  /// Target area per vertex at a triangle: the mean of size^2 over its corners.
  [[nodiscard]] double area(const Triangle& t) const {
    if (uniform()) return 1;
    double sum = 0;
    for (const Index v : t) sum += of_vertex[v] * of_vertex[v];
    return sum / 3;
  }
  /// Factor of the fidelity's weight per area: per vertex, the squared distance counts the same for
  /// sizes from 1/2 to 2; beyond, the distance relative to the size does, since a surface held too
  /// tightly where the mesh is coarse costs angles, and one not held at all shrinks.
  static double fidelity_factor(double area) { return std::clamp(area, 0.25, 4.0) / (area * area); }

  /// Takes the sizes from the mesh itself: three smoothing passes over the vertices' areas.
  void measure(const mesh::EditableMesh& mesh);
  /// A vertex split off the edge ab.
  void add_between(Index a, Index b) {
    if (!uniform()) of_vertex.push_back(0.5 * (of_vertex[a] + of_vertex[b]));
  }

  /// Shape energy of a triangle; with sizes that of the triangle in units of its target, less what
  /// makes the energy stationary at the target area.
  [[nodiscard]] double shape(const Triangle& t, const std::array<Vec3, 3>& p,
                             const energy::ShapeWeights& weights) const;
  /// The same with its gradient by corner.
  double shape(const Triangle& t, const std::array<Vec3, 3>& p, const energy::ShapeWeights& weights,
               std::array<Vec3, 3>& gradient) const;
};

}  // namespace nonobtuse::refine
