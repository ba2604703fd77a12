#include "refine/neighborhood.h"

#include <algorithm>

#include "refine/fidelity.h"

namespace nonobtuse::refine {

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

void add_rings(const mesh::EditableMesh& mesh, std::vector<Index>& vertices, int rings) {
  sort_unique(vertices);
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < count; ++i)
      for_ring(mesh, vertices[i], [&](Index t, int) {
        for (Index v : mesh.triangle(t)) vertices.push_back(v);
      });
    sort_unique(vertices);
  }
}

std::vector<Index> dilated(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles,
                           int rings) {
  std::vector<Index> vertices;
  for (Index t : triangles)
    for (Index v : mesh.triangle(t)) vertices.push_back(v);
  add_rings(mesh, vertices, rings);
  return vertices;
}

std::vector<Index> triangles_around(const mesh::EditableMesh& mesh,
                                    const std::vector<Index>& vertices) {
  std::vector<Index> triangles;
  for (Index v : vertices) for_ring(mesh, v, [&](Index t, int) { triangles.push_back(t); });
  sort_unique(triangles);
  return triangles;
}

}  // namespace nonobtuse::refine
