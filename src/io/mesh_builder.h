// What the four readers hand their vertices and faces to: triangles go straight through, polygons
// wait until all vertices are known and are then triangulated in their place.
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

  /// Corners of one face, in order; indices must be in range by the time of `finish`.
  void add_face(const Index* corners, std::size_t count) {
    if (count == 3) {
      mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    } else if (count < 3) {
      if (too_short_ == 0) first_too_short_ = faces_;
      ++too_short_;
    } else {
      polygons_.push_back({mesh_.triangles.size(), corners_.size(), count, faces_});
      corners_.insert(corners_.end(), corners, corners + count);
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
  };

  void triangulate_polygons();

  const Source& source_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
  std::vector<Polygon> polygons_;
  Index faces_ = 0;
  Index too_short_ = 0;
  Index first_too_short_ = -1;
};

}  // namespace nonobtuse::io
