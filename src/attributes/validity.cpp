#include "attributes/validity.h"

#include <algorithm>
#include <string>

#include "mesh/surface.h"
#include "nonobtuse/error.h"

namespace nonobtuse::attributes {

namespace {

void require_size(std::size_t size, std::size_t wanted, const char* what, const char* of) {
  if (size != 0 && size != wanted)
    throw InvalidInput("There are " + std::to_string(size) + " " + what + " for " +
                       std::to_string(wanted) + " " + of + ": one for each is needed, or none.");
}

}  // namespace

void require_valid(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  require_size(attributes.colors.size(), mesh.vertices.size(), "colours", "vertices");
  require_size(attributes.texture_triangles.size(), mesh.triangles.size(), "texture triangles",
               "faces");
  require_size(attributes.labels.size(), mesh.triangles.size(), "labels", "faces");
  const auto count = static_cast<Index>(attributes.texture_coordinates.size());
  for (std::size_t t = 0; t < attributes.texture_triangles.size(); ++t)
    for (const Index i : attributes.texture_triangles[t])
      if (i < -1 || i >= count)
        throw InvalidInput("Face " + std::to_string(t) + " names texture coordinate " +
                               std::to_string(i) + ", which does not exist.",
                           static_cast<Index>(t));
  for (std::size_t t = 0; t < attributes.labels.size(); ++t)
    if (attributes.labels[t] < 0)
      throw InvalidInput("The label of face " + std::to_string(t) + " is negative.",
                         static_cast<Index>(t));
}

bool texture_agrees(const TriangleMesh& mesh, const MeshAttributes& attributes, Index t,
                    Index other, Index vertex) {
  if (attributes.texture_triangles.empty()) return true;
  const auto at = [&](Index f) {
    const Triangle& corners = mesh.triangles[f];
    const auto k = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return attributes.texture_triangles[f][static_cast<std::size_t>(k)];
  };
  const Index a = at(t);
  const Index b = at(other);
  if (a < 0 || b < 0) return a == b;
  return attributes.texture_coordinates[a] == attributes.texture_coordinates[b];
}

bool is_seam(const TriangleMesh& mesh, const MeshAttributes& attributes, Index t, int k,
             Index other) {
  const Triangle& corners = mesh.triangles[t];
  return !texture_agrees(mesh, attributes, t, other, corners[mesh::next(k)]) ||
         !texture_agrees(mesh, attributes, t, other, corners[mesh::previous(k)]);
}

}  // namespace nonobtuse::attributes
