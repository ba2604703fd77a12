#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "nonobtuse/error.h"
#include "nonobtuse/sample.h"
#include "numeric/vec3.h"
#include "sample/marching_cubes_table.h"

namespace {

using nonobtuse::Index;
using nonobtuse::Triangle;
using nonobtuse::TriangleMesh;
using nonobtuse::Vec3;

// Counts by the definition, with none of the library's mesh code.
struct Counts {
  bool every_edge_twice_opposite = true;
  bool one_fan_per_vertex = true;
  long euler = 0;
  int components = 0;
};

int components_of(const TriangleMesh& mesh) {
  std::vector<Index> parent(mesh.vertices.size());
  for (Index v = 0; v < static_cast<Index>(parent.size()); ++v) parent[v] = v;
  const auto root = [&parent](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::set<Index> roots;
  for (Index v = 0; v < static_cast<Index>(parent.size()); ++v) roots.insert(root(v));
  return static_cast<int>(roots.size());
}

Counts count(const TriangleMesh& mesh) {
  Counts counts;
  std::set<std::pair<Index, Index>> half_edges;
  std::vector<std::map<Index, Index>> link(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      if (!half_edges.insert({a, b}).second) counts.every_edge_twice_opposite = false;
      link[a][b] = t[(k + 2) % 3];
    }
  }
  for (const auto& [a, b] : half_edges)
    if (!half_edges.contains({b, a})) counts.every_edge_twice_opposite = false;
  for (const auto& ring : link) {
    std::size_t steps = 0;
    if (ring.empty()) {
      counts.one_fan_per_vertex = false;
      continue;
    }
    Index at = ring.begin()->first;
    do {
      const auto next = ring.find(at);
      if (next == ring.end()) break;
      at = next->second;
      ++steps;
    } while (at != ring.begin()->first && steps <= ring.size());
    if (steps != ring.size()) counts.one_fan_per_vertex = false;
  }
  counts.euler = static_cast<long>(mesh.vertices.size()) -
                 static_cast<long>(half_edges.size() / 2) +
                 static_cast<long>(mesh.triangles.size());
  counts.components = components_of(mesh);
  return counts;
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  return volume;
}

class SampleSurface : public testing::TestWithParam<Index> {};

TEST_P(SampleSurface, IsAClosedOrientedManifoldOfGenusThree) {
  const TriangleMesh mesh = nonobtuse::sample_surface(GetParam());
  const Counts counts = count(mesh);
  EXPECT_TRUE(counts.every_edge_twice_opposite);
  EXPECT_TRUE(counts.one_fan_per_vertex);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.euler, 2 - 2 * 3);
  EXPECT_GT(signed_volume(mesh), 0);  // normals point outwards
}

INSTANTIATE_TEST_SUITE_P(Resolutions, SampleSurface,
                         testing::Values(16, 17, 19, 23, 24, 31, 32, 48, 53, 64, 96, 101, 128));

TEST(SampleSurface, HasTheBadTrianglesOfMarchingCubes) {
  const TriangleMesh mesh = nonobtuse::sample_surface();
  std::size_t obtuse = 0;
  double smallest_angle = 180;
  for (const Triangle& t : mesh.triangles) {
    bool has_obtuse = false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
      const Vec3 v = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
      const double angle = std::atan2(length(cross(u, v)), dot(u, v)) * 180 / std::acos(-1.0);
      smallest_angle = std::min(smallest_angle, angle);
      has_obtuse = has_obtuse || angle > 90;
    }
    if (has_obtuse) ++obtuse;
    EXPECT_GT(length(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                           mesh.vertices[t[2]] - mesh.vertices[t[0]])),
              0);
  }
  EXPECT_GT(obtuse, mesh.triangles.size() / 10);
  EXPECT_LT(smallest_angle, 10);
}

TEST(SampleSurface, IsTheSameEveryTime) {
  const TriangleMesh a = nonobtuse::sample_surface(32);
  const TriangleMesh b = nonobtuse::sample_surface(32);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(SampleSurface, RefusesSenselessResolutions) {
  EXPECT_THROW(nonobtuse::sample_surface(15), nonobtuse::InvalidInput);
  EXPECT_THROW(nonobtuse::sample_surface(1025), nonobtuse::InvalidInput);
}

// Euler and the link of every case: each crossed edge of the cell is used, loops close, and the
// boundary of the triangles lies on the faces of the cell.
TEST(MarchingCubesTable, EveryCaseUsesExactlyItsCrossedEdges) {
  const auto table = nonobtuse::sample::marching_cubes_table();
  for (int signs = 0; signs < 256; ++signs) {
    std::set<int> used;
    for (const auto& triangle : table[signs]) used.insert(triangle.begin(), triangle.end());
    std::set<int> crossed;
    for (int e = 0; e < 12; ++e) {
      const auto& edge = nonobtuse::sample::cell_edges()[e];
      const bool from = ((signs >> edge.corner) & 1) != 0;
      const bool to = ((signs >> (edge.corner + (1 << edge.axis))) & 1) != 0;
      if (from != to) crossed.insert(e);
    }
    EXPECT_EQ(used, crossed) << "case " << signs;
  }
}

}  // namespace
