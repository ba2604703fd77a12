// What the four readers hand their vertices and faces to: triangles go straight through, polygons
// wait until all vertices are known and are then triangulated in their place. Attributes that not
// every vertex or face has are left out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/scanner.h"
#include "nonobtuse/io.h"
#include "numeric/vec3.h"

namespace nonobtuse::io {

class MeshBuilder {
 public:
  explicit MeshBuilder(const Source& source) : source_(source) {}

  void reserve(std::size_t vertices, std::size_t faces) {
    mesh_.vertices.reserve(vertices);
    mesh_.triangles.reserve(faces);
  }
  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(mesh_.vertices.size()); }
  [[nodiscard]] Index face_count() const { return faces_; }

  /// `where` ("file, line 7: ") is asked only when the vertex is refused.
  template <class Where>
  void add_vertex(const Vec3& p, const Where& where) {
    if (!is_finite(p))
      throw InvalidInput(where() + "vertex " + std::to_string(vertex_count()) +
                             " has a coordinate that is not finite.",
                         vertex_count());
    mesh_.vertices.push_back(p);
  }

  /// Colour of the vertex added last.
  void add_color(const Color& color) { attributes_.colors.push_back(color); }
  void add_texture_coordinate(const TextureCoordinate& at) {
    attributes_.texture_coordinates.push_back(at);
  }
  [[nodiscard]] Index texture_coordinate_count() const {
    return static_cast<Index>(attributes_.texture_coordinates.size());
  }
  /// Label of the faces that follow, >= 0; those before the first call have the label 0.
  void set_label(Index label) {
    if (!labelled_) attributes_.labels.assign(mesh_.triangles.size(), 0);
    labelled_ = true;
    label_ = label;
  }
  void forget_labels() {
    labelled_ = false;
    label_ = 0;
    attributes_.labels.clear();
    for (Polygon& polygon : polygons_) polygon.label = 0;
  }
  MeshAttributes& attributes() { return attributes_; }

  /// Corners of one face, in order; indices must be in range by the time of `finish`. `texture`:
  /// the texture coordinate of each corner, or null; checked in `finish`.
  void add_face(const Index* corners, std::size_t count, const Index* texture = nullptr) {
    if (count == 3) {
      if (texture != nullptr || !attributes_.texture_triangles.empty()) add_texture(texture);
      mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
      if (labelled_) attributes_.labels.push_back(label_);
    } else if (count < 3) {
      if (too_short_ == 0) first_too_short_ = faces_;
      ++too_short_;
    } else {
      polygons_.push_back({mesh_.triangles.size(), corners_.size(), count, faces_, label_});
      corners_.insert(corners_.end(), corners, corners + count);
      if (texture != nullptr) {
        polygon_texture_.resize(corners_.size() - count, -1);
        polygon_texture_.insert(polygon_texture_.end(), texture, texture + count);
      }
    }
    ++faces_;
  }

  /// Triangulates what is left and hands the mesh over. Throws IoError if there is no face.
  ReadResult finish(FileFormat format);

 private:
  struct Polygon {
    std::size_t position;  // triangles before it
    std::size_t begin;     // in corners_
    std::size_t count;
    Index face;  // number in the file
    Index label;
  };

  void add_texture(const Index* texture) {
    attributes_.texture_triangles.resize(mesh_.triangles.size(), {-1, -1, -1});
    attributes_.texture_triangles.push_back(
        texture != nullptr ? Triangle{texture[0], texture[1], texture[2]} : Triangle{-1, -1, -1});
  }
  [[nodiscard]] Triangle polygon_texture(const Polygon& polygon, const Triangle& part) const;
  void triangulate_polygons();
  void complete_attributes();

  const Source& source_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
  std::vector<Polygon> polygons_;
  std::vector<Index> polygon_texture_;  // of corners_, as far as there is any
  MeshAttributes attributes_;
  bool labelled_ = false;
  Index label_ = 0;
  Index faces_ = 0;
  Index too_short_ = 0;
  Index first_too_short_ = -1;
};

}  // namespace nonobtuse::io
