#include "io/mesh_builder.h"

#include <utility>

#include "io/polygon_triangulation.h"

namespace nonobtuse::io {

void MeshBuilder::triangulate_polygons() {
  std::vector<Triangle> merged;
  merged.reserve(mesh_.triangles.size() + corners_.size() - 2 * polygons_.size());
  std::size_t copied = 0;
  for (const Polygon& polygon : polygons_) {
    merged.insert(merged.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(copied),
                  mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(polygon.position));
    copied = polygon.position;
    if (polygon.count > max_polygon_corners)
      throw InvalidInput(source_.name + ": face " + std::to_string(polygon.face) + " has " +
                             std::to_string(polygon.count) +
                             " corners; triangulate such faces before.",
                         polygon.face);
    triangulate_polygon(mesh_.vertices, corners_.data() + polygon.begin, polygon.count, merged);
  }
  merged.insert(merged.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(copied),
                mesh_.triangles.end());
  mesh_.triangles = std::move(merged);
}

ReadResult MeshBuilder::finish(FileFormat format) {
  ReadResult result;
  result.format = format;
  if (too_short_ > 0)
    result.repairs.push_back(
        {"faces with fewer than three corners dropped", too_short_, first_too_short_});
  if (!polygons_.empty()) {
    result.repairs.push_back(
        {"polygons triangulated", static_cast<Index>(polygons_.size()), polygons_.front().face});
    triangulate_polygons();
  }
  if (mesh_.triangles.empty())
    throw IoError(source_.name + ": there are no faces in this file (" +
                  std::to_string(mesh_.vertices.size()) + " vertices).");
  result.mesh = std::move(mesh_);
  return result;
}

}  // namespace nonobtuse::io
