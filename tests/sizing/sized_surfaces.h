// Surfaces and fields for the tests of sizing.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/surface.h"
#include "rdt/shapes.h"
#include "rvd/test_surfaces.h"
#include "sizing/density.h"

namespace nonobtuse::sizing::test {

inline TriangleMesh sphere(int levels) {
  const mesh::Surface s = rvd::test::octasphere(levels);
  return {s.vertices, s.triangles};
}

inline mesh::Surface surface_of(const TriangleMesh& mesh) {
  return mesh::make_surface(mesh.vertices, mesh.triangles);
}

/// h at the vertices: `ratio` times as long above z = `end` as below z = `begin`, between them
/// growing geometrically.
inline std::vector<double> steep_field(const std::vector<Vec3>& vertices, double ratio,
                                       double begin, double end) {
  std::vector<double> h;
  for (const Vec3& v : vertices)
    h.push_back(std::pow(ratio, std::clamp((v.z - begin) / (end - begin), 0.0, 1.0)));
  return h;
}

/// Hands lengths to a surface as relative sizes: the integral of size^-2 becomes the area.
inline void set_sizes(mesh::Surface& surface, std::vector<double> lengths) {
  const double scale =
      std::sqrt(0.5 * std::sqrt(3.0) * vertices_for(surface, lengths) / surface.area);
  for (double& h : lengths) h *= scale;
  surface.size = std::move(lengths);
}

}  // namespace nonobtuse::sizing::test
