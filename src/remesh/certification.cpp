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

// The nearest point of the input on the sheet a vertex belongs to, told by the normals.
void locate_vertices(const mesh::Surface& surface, const TriangleMesh& working,
                     const parallel::Workers& workers, RemeshResult& result) {
  const spatial::TriangleBvh bvh(surface.vertices, surface.triangles, workers);
  const std::vector<Vec3> normals = vertex_normals(working);
  result.source_triangle.resize(working.vertices.size());
  result.barycentric.resize(working.vertices.size());
  workers.for_each(working.vertices.size(), 256, [&](std::size_t v) {
    const Vec3& p = working.vertices[v];
    auto hit =
        bvh.closest_if(p, 4.0, [&](Index t) { return dot(surface.normals[t], normals[v]) > 0; });
    if (hit.triangle < 0) hit = bvh.closest(p);
    result.source_triangle[v] = hit.triangle;
    result.barycentric[v] = hit.barycentric;
  });
}

}  // namespace

void certify_result(const NormalizedInput& input, const mesh::EditableMesh& mesh,
                    const RemeshOptions& options, const parallel::Workers& workers,
                    RemeshResult& result) {
  result.mesh = mesh.to_mesh();
  locate_vertices(input.surface, result.mesh, workers, result);
  for (Vec3& v : result.mesh.vertices) v = input.map.to_input(v);
  result.certificate = certify(result.mesh);
  result.goal = certify(result.mesh, {options.min_angle, std::min(options.max_angle, 90.0)});
  result.angles = measure_angles(result.mesh);
  result.status = result.goal.certified ? Status::Converged : Status::AnglesRemain;
}

}  // namespace nonobtuse::pipeline
