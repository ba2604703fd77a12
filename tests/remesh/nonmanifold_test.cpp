// Surfaces that meet along edges of three or more faces, or touch in a vertex: both are kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/topology.h"
#include "nonobtuse/error.h"
#include "nonobtuse/io.h"
#include "nonobtuse/quality.h"
#include "nonobtuse/remesh.h"
#include "numeric/vec3.h"

namespace nonobtuse {
namespace {

// Pages of 2 by 3 around a common spine from (0, 0, 0) to (0, 0, 3), each of `cells` x 3 cells/2
// squares cut along a diagonal.
TriangleMesh book(int pages, Index cells) {
  TriangleMesh mesh;
  const Index rows = 3 * cells / 2;
  for (Index j = 0; j <= rows; ++j) mesh.vertices.push_back({0, 0, 3.0 * j / rows});
  for (int p = 0; p < pages; ++p) {
    const double angle = 2 * 3.141592653589793 * p / pages;
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (Index i = 1; i <= cells; ++i)
      for (Index j = 0; j <= rows; ++j)
        mesh.vertices.push_back(
            {2.0 * i / cells * std::cos(angle), 2.0 * i / cells * std::sin(angle), 3.0 * j / rows});
    const auto at = [&](Index i, Index j) { return i == 0 ? j : first + (i - 1) * (rows + 1) + j; };
    for (Index i = 0; i < cells; ++i)
      for (Index j = 0; j < rows; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return mesh;
}

// Edges of three or more faces.
std::vector<mesh::EdgeSide> crowded_edges(const TriangleMesh& mesh) {
  std::vector<mesh::EdgeSide> edges;
  mesh::for_each_edge(mesh::edge_sides(mesh.triangles, static_cast<Index>(mesh.vertices.size())),
                      [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
                        if (last - first > 2) edges.push_back(*first);
                      });
  return edges;
}

TEST(NonManifold, PagesMeetAlongTheirSpine) {
  for (const int pages : {3, 4, 5}) {
    const TriangleMesh input = book(pages, 6);
    RemeshOptions options;
    options.vertices = 800;
    const RemeshResult result = remesh(input, options);
    EXPECT_EQ(result.mesh.vertices.size(), 800u);
    EXPECT_TRUE(result.certificate.certified);
    const Topology before = measure_topology(input);
    const Topology after = measure_topology(result.mesh);
    EXPECT_EQ(after.components, 1);
    EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
    // The spine: a chain of edges from end to end, each with one face per page.
    double length = 0;
    for (const mesh::EdgeSide& e : crowded_edges(result.mesh)) {
      for (const Index v : {e.low, e.high}) {
        EXPECT_NEAR(result.mesh.vertices[v].x, 0, 1e-12);
        EXPECT_NEAR(result.mesh.vertices[v].y, 0, 1e-12);
      }
      length += distance(result.mesh.vertices[e.low], result.mesh.vertices[e.high]);
    }
    EXPECT_NEAR(length, 3, 1e-9);
    // Flat pages stay flat, and their corners stay where they are.
    for (const Vec3& corner : {input.vertices.front(), input.vertices.back()})
      EXPECT_EQ(std::count(result.mesh.vertices.begin(), result.mesh.vertices.end(), corner), 1);
  }
}

TEST(NonManifold, FansThatTouchKeepTheirPoint) {
  // Two pages of different books that share one corner.
  TriangleMesh input = book(1, 6);
  const TriangleMesh other = book(1, 6);
  const auto shift = static_cast<Index>(input.vertices.size());
  const Vec3 corner = input.vertices.front();
  for (const Vec3& p : other.vertices) input.vertices.push_back({-p.x, p.y, -p.z});
  for (const Triangle& t : other.triangles) {
    const auto at = [&](Index v) { return v == 0 ? 0 : v + shift; };
    input.triangles.push_back({at(t[0]), at(t[1]), at(t[2])});
  }
  RemeshOptions options;
  options.vertices = 400;
  const RemeshResult result = remesh(clean(input).mesh, options);
  EXPECT_EQ(result.mesh.vertices.size(), 400u);
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_EQ(measure_topology(result.mesh).nonmanifold_vertices, 1);
  EXPECT_EQ(std::count(result.mesh.vertices.begin(), result.mesh.vertices.end(), corner), 1);
}

TEST(NonManifold, ThePapersMethodsSaySo) {
  RemeshOptions options;
  options.vertices = 400;
  options.method = Method::Cvt;
  EXPECT_THROW(remesh(book(3, 6), options), InvalidInput);
}

}  // namespace
}  // namespace nonobtuse
