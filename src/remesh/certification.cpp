#include "remesh/certification.h"

#include <algorithm>
#include <vector>

#include "nonobtuse/quality.h"
#include "numeric/vec3.h"
#include "spatial/triangle_bvh.h"

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

void append(const Part& part, const NormalizedInput& input, const TriangleMesh& working,
            const parallel::Workers& workers, RemeshResult& result) {
  const mesh::Surface& surface = input.surface;
  const spatial::TriangleBvh bvh(surface.vertices, surface.triangles, workers);
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

void append_part(const Part& part, const NormalizedInput& input, const mesh::EditableMesh& mesh,
                 const parallel::Workers& workers, RemeshResult& result) {
  append(part, input, mesh.to_mesh(), workers, result);
}

void append_part(const Part& part, const NormalizedInput& input, const GluedMesh& glued,
                 const parallel::Workers& workers, RemeshResult& result) {
  const auto first = static_cast<Index>(result.mesh.vertices.size());
  append(part, input, glued.mesh, workers, result);
  for (std::size_t v = 0; v < glued.source.size(); ++v)
    if (glued.source[v] >= 0) result.mesh.vertices[first + v] = part.mesh.vertices[glued.source[v]];
  for (const std::array<Index, 2>& e : glued.feature_edges)
    result.feature_edges.push_back({e[0] + first, e[1] + first});
}

void certify_result(const RemeshOptions& options, RemeshResult& result) {
  result.certificate = certify(result.mesh);
  result.goal = certify(result.mesh, {options.min_angle, options.max_angle});
  result.angles = measure_angles(result.mesh);
  result.status = result.goal.certified ? Status::Converged : Status::AnglesRemain;
}

}  // namespace nonobtuse::pipeline
