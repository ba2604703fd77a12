#include <algorithm>

#include "attributes/validity.h"
#include "mesh/topology.h"

namespace nonobtuse {

std::vector<std::array<Index, 2>> attribute_borders(const TriangleMesh& mesh,
                                                    const MeshAttributes& attributes) {
  attributes::require_valid(mesh, attributes);
  std::vector<std::array<Index, 2>> borders;
  if (attributes.labels.empty() && attributes.texture_triangles.empty()) return borders;
  const auto sides = mesh::edge_sides(mesh.triangles, static_cast<Index>(mesh.vertices.size()));
  mesh::for_each_edge(sides, [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
    const bool differ = std::any_of(first + 1, last, [&](const mesh::EdgeSide& side) {
      const Index a = first->triangle;
      const Index b = side.triangle;
      if (!attributes.labels.empty() && attributes.labels[a] != attributes.labels[b]) return true;
      return !attributes::texture_agrees(mesh, attributes, a, b, side.low) ||
             !attributes::texture_agrees(mesh, attributes, a, b, side.high);
    });
    if (differ) borders.push_back({first->low, first->high});
  });
  return borders;
}

}  // namespace nonobtuse
