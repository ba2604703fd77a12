#include "quality/validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nonobtuse/error.h"
#include "numeric/vec3.h"

namespace nonobtuse::quality {

void require_measurable(const TriangleMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  for (std::size_t v = 0; v < count; ++v)
    if (!is_finite(mesh.vertices[v]))
      throw InvalidInput(fmt::format("Vertex {} has a coordinate that is not finite.", v),
                         static_cast<Index>(v));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t])
      if (v < 0 || static_cast<std::size_t>(v) >= count)
        throw InvalidInput(
            fmt::format("Triangle {} refers to vertex {}, but there are {} vertices.", t, v, count),
            static_cast<Index>(t));
}

double unit_scale(const TriangleMesh& mesh) {
  Vec3 largest;
  for (const Vec3& p : mesh.vertices) largest = max(largest, max(p, -p));
  const double m = std::max({largest.x, largest.y, largest.z});
  if (m == 0) return 1;
  int exponent = 0;
  std::frexp(m, &exponent);
  // A scale that is itself finite; meshes of denormal size stay small, which does no harm.
  return std::ldexp(1.0, std::min(-exponent, 1000));
}

TriangleMesh scaled(const TriangleMesh& mesh, double scale) {
  TriangleMesh result = mesh;
  for (Vec3& p : result.vertices) p *= scale;
  return result;
}

}  // namespace nonobtuse::quality
