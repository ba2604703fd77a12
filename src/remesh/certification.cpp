#include "remesh/certification.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "nonobtuse/quality.h"
#include "numeric/vec3.h"

namespace nonobtuse::pipeline {

namespace {

// Vertex normals weighted by area; good enough to tell the two sides of a thin sheet apart.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    for (const Index v : t) normals[v] += a;
  }
  return normals;
}

// Squared distance, in edge lengths, within which the sheet told by the normal is preferred.
constexpr double kNear = 4;

void append(const Part& part, const NormalizedInput& input, const spatial::TriangleBvh& bvh,
            const TriangleMesh& working, const parallel::Workers& workers, RemeshResult& result) {
  const mesh::Surface& surface = input.surface;
  const std::vector<Vec3> normals = vertex_normals(working);
  const std::size_t first = result.mesh.vertices.size();
  const std::size_t count = working.vertices.size();
  result.mesh.vertices.resize(first + count);
  result.source_triangle.resize(first + count);
  result.barycentric.resize(first + count);
  workers.for_each(count, 256, [&](std::size_t v) {
    const Vec3& p = working.vertices[v];
    auto hit =
        bvh.closest_if(p, kNear, [&](Index t) { return dot(surface.normals[t], normals[v]) > 0; });
    if (hit.triangle < 0) hit = bvh.closest(p);
    result.mesh.vertices[first + v] = input.map.to_input(p);
    result.source_triangle[first + v] = part.facet[hit.triangle];
    result.barycentric[first + v] = hit.barycentric;
  });
  const auto shift = static_cast<Index>(first);
  for (const Triangle& t : working.triangles)
    result.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

}  // namespace

void append_part(const Part& part, const NormalizedInput& input, const spatial::TriangleBvh& bvh,
                 const mesh::EditableMesh& mesh, const parallel::Workers& workers,
                 RemeshResult& result) {
  append(part, input, bvh, mesh.to_mesh(), workers, result);
}

void append_part(const Part& part, const NormalizedInput& input, const GluedMesh& glued,
                 const parallel::Workers& workers, RemeshResult& result) {
  const auto first = static_cast<Index>(result.mesh.vertices.size());
  const spatial::TriangleBvh bvh(input.surface.vertices, input.surface.triangles, workers);
  append(part, input, bvh, glued.mesh, workers, result);
  for (std::size_t v = 0; v < glued.source.size(); ++v)
    if (glued.source[v] >= 0) result.mesh.vertices[first + v] = part.mesh.vertices[glued.source[v]];
  for (const std::array<Index, 2>& e : glued.feature_edges)
    result.feature_edges.push_back({e[0] + first, e[1] + first});
  for (NarrowCorner corner : glued.narrow_corners) {
    corner.vertex += first;
    result.narrow_corners.push_back(corner);
  }
}

namespace {

void measure_narrow_corners(RemeshResult& result) {
  std::vector<double> least(result.mesh.vertices.size(), 180);
  for (const Triangle& t : result.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = result.mesh.vertices[t[mesh::next(k)]] - result.mesh.vertices[t[k]];
      const Vec3 b = result.mesh.vertices[t[mesh::previous(k)]] - result.mesh.vertices[t[k]];
      least[t[k]] = std::min(
          least[t[k]], std::atan2(length(cross(a, b)), dot(a, b)) * (180 / 3.14159265358979323846));
    }
  for (NarrowCorner& corner : result.narrow_corners) corner.reached_angle = least[corner.vertex];
}

}  // namespace

void certify_result(const RemeshOptions& options, RemeshResult& result) {
  result.certificate = certify(result.mesh);
  result.goal = certify(result.mesh, {options.min_angle, options.max_angle});
  result.angles = measure_angles(result.mesh);
  measure_narrow_corners(result);
  const bool done =
      certified_but_for_narrow_corners(result.mesh, result.goal, result.narrow_corners);
  result.status = done ? Status::Converged : Status::AnglesRemain;
}

}  // namespace nonobtuse::pipeline

namespace nonobtuse {

bool certified_but_for_narrow_corners(const TriangleMesh& mesh, const Certificate& certificate,
                                      const std::vector<NarrowCorner>& corners) {
  if (certificate.certified) return true;
  if (corners.empty() || certificate.triangles == 0) return false;
  std::vector<char> narrow(mesh.vertices.size(), 0);
  for (const NarrowCorner& corner : corners) narrow[corner.vertex] = 1;
  const auto excused = [&](Index t) {
    const Triangle& v = mesh.triangles[t];
    return narrow[v[0]] != 0 || narrow[v[1]] != 0 || narrow[v[2]] != 0;
  };
  return std::all_of(certificate.too_large.begin(), certificate.too_large.end(), excused) &&
         std::all_of(certificate.too_small.begin(), certificate.too_small.end(), excused);
}

}  // namespace nonobtuse
