// Meshes that come to rest on the surface: lower energy, the same topology, vertices on it.
#include "remesh/mesh_tessellation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "energy/mesh_shape.h"
#include "rdt/shapes.h"
#include "remesh/first_mesh.h"
#include "remesh/mesh_subdivision.h"
#include "remesh/normalization.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {
namespace {

// A mesh of the surface of `fine`: the vertices of `coarse` pulled onto it.
MeshOnSurface on_surface(const mesh::Surface& surface, const NormalizedInput& input,
                         const TriangleMesh& coarse) {
  const spatial::TriangleBvh bvh(surface.vertices, surface.triangles, parallel::Workers(1));
  std::vector<Vec3> positions;
  std::vector<Index> foot;
  for (const Vec3& v : coarse.vertices) {
    const auto hit = bvh.closest(input.map.to_working(v));
    positions.push_back(hit.point);
    foot.push_back(hit.triangle);
  }
  return {mesh::EditableMesh(positions, coarse.triangles), foot};
}

double energy_of(const mesh::EditableMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles())
    sum += energy::triangle_shape(
        energy::squared_edges(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]),
        {1, 0});
  return sum;
}

double farthest_from(const mesh::Surface& surface, const MeshOnSurface& t) {
  double farthest = 0;
  for (std::size_t v = 0; v < t.foot.size(); ++v) {
    const Triangle& f = surface.triangles[t.foot[v]];
    const double height =
        dot(surface.normals[t.foot[v]], t.mesh.positions[v] - surface.vertices[f[0]]);
    farthest = std::max(farthest, std::abs(height));
  }
  return farthest;
}

struct Case {
  TriangleMesh fine, coarse;
};

std::vector<Case> cases() {
  return {{shapes::sphere(4), shapes::sphere(3)}, {shapes::torus(60, 30), shapes::torus(30, 12)}};
}

TEST(MeshTessellation, DescendsOnTheSurfaceAndKeepsTheTopology) {
  for (const Case& c : cases()) {
    const NormalizedInput input = normalize(c.fine, static_cast<Index>(c.coarse.vertices.size()));
    const mesh::Surface& surface = input.surface;
    MeshOnSurface t = on_surface(surface, input, c.coarse);
    const double before = energy_of(t.mesh);
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 2}) {
      MeshOnSurface moved = t;
      minimize_on_mesh(surface, moved, {30, 2, 0}, parallel::Workers(threads), [] { return true; });
      ASSERT_NO_THROW(moved.mesh.check_invariants());
      EXPECT_EQ(shapes::topology(moved.mesh.to_mesh().triangles),
                shapes::topology(c.coarse.triangles));
      EXPECT_LT(energy_of(moved.mesh), before);
      EXPECT_LT(farthest_from(surface, moved), 1e-9);
      EXPECT_EQ(unfold(surface, moved), 0);
      results.push_back(moved.mesh.positions);
    }
    EXPECT_TRUE(results[0] == results[1]) << "the same for any number of threads";
  }
}

TEST(MeshTessellation, UnfoldsATriangleTurnedOver) {
  const Case c = cases().front();
  const NormalizedInput input = normalize(c.fine, static_cast<Index>(c.coarse.vertices.size()));
  MeshOnSurface t = on_surface(input.surface, input, c.coarse);
  std::vector<Index> ring;
  t.mesh.neighbors(0, ring);
  std::swap(t.mesh.positions[0], t.mesh.positions[ring[0]]);
  std::swap(t.foot[0], t.foot[ring[0]]);
  EXPECT_EQ(unfold(input.surface, t), 0);
}

TEST(MeshSubdivision, HasTheCountAskedForAndNewVerticesOfValenceSix) {
  for (const Case& c : cases()) {
    const NormalizedInput input = normalize(c.fine, static_cast<Index>(c.coarse.vertices.size()));
    const MeshOnSurface coarse = on_surface(input.surface, input, c.coarse);
    const shapes::Topology before = shapes::topology(c.coarse.triangles);
    const Index whole = coarse.mesh.vertex_count() + coarse.mesh.triangle_count() * 3 / 2;  // V + E
    for (const Index count : {whole - 2, whole, whole + 2}) {
      const MeshOnSurface fine = subdivided(input.surface, coarse, count);
      ASSERT_NO_THROW(fine.mesh.check_invariants());
      shapes::Topology expected = before;
      expected.vertices = count;
      EXPECT_EQ(shapes::topology(fine.mesh.to_mesh().triangles), expected);
      EXPECT_LT(farthest_from(input.surface, fine), 1e-9);
      EXPECT_EQ(fine.foot.size(), fine.mesh.positions.size());
      if (count != whole) continue;
      Index irregular = 0, coarsely = 0;
      for (Index v = 0; v < count; ++v) irregular += fine.mesh.valence(v) != 6;
      for (Index v = 0; v < coarse.mesh.vertex_count(); ++v)
        coarsely += coarse.mesh.valence(v) != 6;
      EXPECT_EQ(irregular, coarsely);
    }
  }
}

FirstMesh run(const mesh::Surface& surface, Index n, int threads) {
  const Context context;
  parallel::Monitor monitor(context);
  return first_mesh(surface, {.sites = n, .seed = 1}, parallel::Workers(threads), monitor);
}

TEST(FirstMesh, HasTheSurfacesTopologyAndTheSameBitsForAnyThreads) {
  const TriangleMesh torus = shapes::torus(60, 30);
  const mesh::Surface surface = normalize(torus, 1500).surface;
  const FirstMesh one = run(surface, 1500, 1);
  ASSERT_EQ(one.tessellation.mesh.vertex_count(), 1500);
  ASSERT_NO_THROW(one.tessellation.mesh.check_invariants());
  shapes::Topology expected = shapes::topology(torus.triangles);
  expected.vertices = 1500;
  EXPECT_EQ(shapes::topology(one.tessellation.mesh.to_mesh().triangles), expected);
  Index regular = 0;
  for (Index v = 0; v < 1500; ++v) regular += one.tessellation.mesh.valence(v) == 6;
  EXPECT_GT(regular, 1300);
  const FirstMesh two = run(surface, 1500, 2);
  EXPECT_TRUE(one.tessellation.mesh.positions == two.tessellation.mesh.positions);
  EXPECT_TRUE(one.tessellation.mesh.triangles() == two.tessellation.mesh.triangles());
}

TEST(FirstMesh, LeavesThinOpenAndManifoldsInPiecesToOthers) {
  TriangleMesh plate = shapes::box(16, 16, 1);
  for (Vec3& v : plate.vertices) v.z *= 0.01;
  for (const TriangleMesh& m : {plate, shapes::square(10)}) {
    const mesh::Surface surface = normalize(m, 1200).surface;
    EXPECT_EQ(run(surface, 1200, 1).tessellation.mesh.vertex_count(), 0);
  }
}

}  // namespace
}  // namespace nonobtuse::pipeline
