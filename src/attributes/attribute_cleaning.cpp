// Attributes of a cleaned mesh, by where its vertices and faces come from.
#include <algorithm>
#include <utility>

#include "attributes/validity.h"
#include "nonobtuse/io.h"

namespace nonobtuse {

namespace {

// The texture coordinates of a face's corners: those of its source at the same vertices; at a
// vertex that the source does not have, those of the first face of the input that has it.
class TextureOfCorners {
 public:
  TextureOfCorners(const TriangleMesh& mesh, const MeshAttributes& attributes)
      : mesh_(mesh), attributes_(attributes), anywhere_(mesh.vertices.size(), -1) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        Index& first = anywhere_[mesh.triangles[t][k]];
        if (first < 0) first = attributes.texture_triangles[t][k];
      }
  }

  [[nodiscard]] Triangle of(const Triangle& vertices, Index source) const {
    const Triangle& there = mesh_.triangles[source];
    Triangle result{};
    for (int k = 0; k < 3; ++k) {
      const auto m = std::find(there.begin(), there.end(), vertices[k]) - there.begin();
      result[k] = m < 3 ? attributes_.texture_triangles[source][static_cast<std::size_t>(m)]
                        : anywhere_[vertices[k]];
    }
    if (*std::min_element(result.begin(), result.end()) < 0) return {-1, -1, -1};
    return result;
  }

 private:
  const TriangleMesh& mesh_;
  const MeshAttributes& attributes_;
  std::vector<Index> anywhere_;
};

}  // namespace

CleanResult clean(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  attributes::require_valid(mesh, attributes);
  CleanResult result = clean(mesh);
  MeshAttributes& out = result.attributes;
  out.texture_coordinates = attributes.texture_coordinates;
  out.label_names = attributes.label_names;
  out.labels_are_groups = attributes.labels_are_groups;
  out.material_library = attributes.material_library;
  if (!attributes.colors.empty())
    for (const Index v : result.source_vertex) out.colors.push_back(attributes.colors[v]);
  if (!attributes.labels.empty())
    for (const Index t : result.source_triangle) out.labels.push_back(attributes.labels[t]);
  if (!attributes.texture_triangles.empty()) {
    const TextureOfCorners texture(mesh, attributes);
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
      Triangle given = result.mesh.triangles[t];
      for (Index& v : given) v = result.source_vertex[v];
      out.texture_triangles.push_back(texture.of(given, result.source_triangle[t]));
    }
  }
  return result;
}

}  // namespace nonobtuse
