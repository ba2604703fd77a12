#include "io/mesh_builder.h"

#include <algorithm>
#include <utility>

#include "io/polygon_triangulation.h"

namespace nonobtuse::io {

Triangle MeshBuilder::polygon_texture(const Polygon& polygon, const Triangle& part) const {
  Triangle texture{-1, -1, -1};
  if (polygon.begin + polygon.count > polygon_texture_.size()) return texture;
  const auto first = corners_.begin() + static_cast<std::ptrdiff_t>(polygon.begin);
  for (int k = 0; k < 3; ++k) {
    const auto at =
        std::find(first, first + static_cast<std::ptrdiff_t>(polygon.count), part[k]) - first;
    texture[k] = polygon_texture_[polygon.begin + static_cast<std::size_t>(at)];
  }
  return texture;
}

void MeshBuilder::triangulate_polygons() {
  const bool textured = !attributes_.texture_triangles.empty() || !polygon_texture_.empty();
  if (textured) attributes_.texture_triangles.resize(mesh_.triangles.size(), {-1, -1, -1});
  std::vector<Triangle> merged;
  std::vector<Triangle> texture;
  std::vector<Index> labels;
  merged.reserve(mesh_.triangles.size() + corners_.size() - 2 * polygons_.size());
  std::size_t copied = 0;
  const auto copy_until = [&](std::size_t end) {
    const auto append = [&](const auto& from, auto& to) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(copied),
                from.begin() + static_cast<std::ptrdiff_t>(end));
    };
    append(mesh_.triangles, merged);
    if (textured) append(attributes_.texture_triangles, texture);
    if (labelled_) append(attributes_.labels, labels);
    copied = end;
  };
  for (const Polygon& polygon : polygons_) {
    copy_until(polygon.position);
    if (polygon.count > max_polygon_corners)
      throw InvalidInput(source_.name + ": face " + std::to_string(polygon.face) + " has " +
                             std::to_string(polygon.count) +
                             " corners; triangulate such faces before.",
                         polygon.face);
    const std::size_t before = merged.size();
    triangulate_polygon(mesh_.vertices, corners_.data() + polygon.begin, polygon.count, merged);
    for (std::size_t t = before; t < merged.size(); ++t) {
      if (textured) texture.push_back(polygon_texture(polygon, merged[t]));
      if (labelled_) labels.push_back(polygon.label);
    }
  }
  copy_until(mesh_.triangles.size());
  mesh_.triangles = std::move(merged);
  attributes_.texture_triangles = std::move(texture);
  attributes_.labels = std::move(labels);
}

// Arrays complete or empty, and no index out of range: a wrong texture is no reason to refuse a
// mesh.
void MeshBuilder::complete_attributes() {
  if (attributes_.colors.size() != mesh_.vertices.size()) attributes_.colors.clear();
  std::vector<Triangle>& texture = attributes_.texture_triangles;
  if (texture.empty()) {
    attributes_.texture_coordinates.clear();
    return;
  }
  texture.resize(mesh_.triangles.size(), {-1, -1, -1});
  for (Triangle& t : texture)
    for (const Index i : t)
      if (i < 0 || i >= texture_coordinate_count()) {
        t = {-1, -1, -1};
        break;
      }
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
  complete_attributes();
  result.mesh = std::move(mesh_);
  result.attributes = std::move(attributes_);
  return result;
}

}  // namespace nonobtuse::io
