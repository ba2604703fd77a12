// Shape energies of a triangle as functions of its three squared edge lengths: what remains of the
// CVT energy, the circumcentre term and the angle hinge when there is a mesh and no Voronoi
// diagram. All are scaled to triangles of an ideal mesh with one unit of area per vertex.
#pragma once

#include <array>
#include <cmath>

#include "nonobtuse/mesh.h"
#include "numeric/vec3.h"

namespace nonobtuse::energy {

/// Weights and thresholds of the energy of a triangle.
struct ShapeWeights {
  double cvt = 1;           ///< exact CVT energy of the planar Voronoi pieces
  double circumcentre = 1;  ///< squared distance of circumcentre and incentre (Sieger et al. 2010)
  double hinge = 0;         ///< squared excess of the cosines over the two thresholds
  double cos_largest = 0;   ///< angles with a smaller cosine are penalised
  double cos_smallest = 1;  ///< angles with a larger cosine are penalised
};

/// Cosine of an angle in degrees.
inline double cos_degrees(double degrees) {
  return std::cos(degrees * (3.14159265358979323846 / 180));
}

/// The hinge with the given weight that keeps angles inside [smallest, largest] degrees.
inline ShapeWeights hinged(double weight, double smallest, double largest) {
  return {1, 1, weight, cos_degrees(largest), cos_degrees(smallest)};
}

/// Squared lengths of the edges opposite corners 0, 1, 2.
inline std::array<double, 3> squared_edges(const Vec3& p0, const Vec3& p1, const Vec3& p2) {
  return {squared_distance(p1, p2), squared_distance(p2, p0), squared_distance(p0, p1)};
}

/// Energy of a triangle with squared edges `s`; with `derivative` its three partial derivatives.
/// Infinite (derivative untouched) for a triangle without area.
double triangle_shape(const std::array<double, 3>& s, const ShapeWeights& weights,
                      std::array<double, 3>* derivative = nullptr);

/// The same for corner positions; the gradient is by corner.
double triangle_shape(const Vec3& p0, const Vec3& p1, const Vec3& p2, const ShapeWeights& weights,
                      std::array<Vec3, 3>& gradient);

}  // namespace nonobtuse::energy
