// Whatever the sites: exactly n vertices, a manifold, the surface's topology; or TooFewVertices.
#include "remesh/extraction.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "nonobtuse/error.h"
#include "nonobtuse/io.h"
#include "rdt/label_guided_collapse.h"
#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;
using pipeline::Extraction;
using pipeline::ExtractionRoute;

Extraction run(const mesh::Surface& s, const std::vector<Vec3>& sites, int threads = 1) {
  const parallel::Workers workers(threads);
  const Context context;
  parallel::Monitor monitor(context);
  return pipeline::extract(s, sites, workers, monitor);
}

void expect_topology(const mesh::EditableMesh& m, const TriangleMesh& input, Index n,
                     const std::string& name) {
  ASSERT_NO_THROW(m.check_invariants()) << name;
  shapes::Topology expected = shapes::topology(input.triangles);
  expected.vertices = n;
  EXPECT_EQ(shapes::topology(m.to_mesh().triangles), expected) << name << " n = " << n;
}

struct Named {
  std::string name;
  TriangleMesh mesh;
};

std::vector<Named> shapes_to_try() {
  std::vector<Named> all{{"sphere", shapes::sphere(3)},
                         {"torus", shapes::torus(24, 12)},
                         {"thin torus", shapes::torus(40, 6, 0.05)},
                         {"square", shapes::square(10)},
                         {"cylinder", shapes::cylinder(6, 18)},
                         {"box", shapes::box(4, 3, 2)}};
  // A thin plate: two sheets nearer to each other than the sites.
  TriangleMesh plate = shapes::box(16, 16, 1);
  for (Vec3& v : plate.vertices) v.z *= 0.01;
  all.push_back({"plate", plate});
  // Two components.
  TriangleMesh two = shapes::sphere(2);
  const TriangleMesh other = shapes::torus(12, 8);
  const Index shift = static_cast<Index>(two.vertices.size());
  for (const Vec3& v : other.vertices) two.vertices.push_back(v + Vec3{4, 0, 0});
  for (const Triangle& t : other.triangles)
    two.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  all.push_back({"two components", two});
  return all;
}

TEST(Extraction, AlwaysTheTopologyOfTheSurface) {
  int routes[3] = {0, 0, 0};
  for (const Named& shape : shapes_to_try()) {
    for (const Index n : {20, 40, 90, 250}) {
      const mesh::Surface s = shapes::scaled_surface(shape.mesh, n);
      for (std::uint64_t seed = 0; seed < 2; ++seed) {
        const Extraction e = run(s, shapes::random_sites(s, n, seed));
        ++routes[static_cast<int>(e.route)];
        expect_topology(e.mesh, shape.mesh, n, shape.name);
        ASSERT_EQ(e.foot.size(), n);
        for (const Index f : e.foot) {
          ASSERT_GE(f, 0);
          ASSERT_LT(f, static_cast<Index>(s.triangles.size()));
        }
      }
    }
  }
  for (const int count : routes) EXPECT_GT(count, 0);
}

TEST(Extraction, TooFewVerticesSayHowManyWereReached) {
  const TriangleMesh torus = shapes::torus(24, 12);
  for (const Index n : {1, 2, 3, 5}) {
    const mesh::Surface s = shapes::scaled_surface(torus, n);
    try {
      run(s, shapes::random_sites(s, n, 4));
      ADD_FAILURE() << "a torus has at least 7 vertices";
    } catch (const TooFewVertices& e) {
      EXPECT_GE(e.least(), 7);
      EXPECT_LE(e.least(), 16);
    }
  }
  const mesh::Surface s = shapes::scaled_surface(shapes::sphere(3), 4);
  expect_topology(run(s, shapes::random_sites(s, 4, 1)).mesh, shapes::sphere(3), 4, "tetrahedron");
}

TEST(Extraction, CoincidentSitesStillGiveAllVertices) {
  const TriangleMesh m = shapes::torus(24, 12);
  const mesh::Surface s = shapes::scaled_surface(m, 60);
  std::vector<Vec3> sites = shapes::random_sites(s, 40, 1);
  for (int i = 0; i < 20; ++i) sites.push_back(sites[i % 3]);
  expect_topology(run(s, sites).mesh, m, 60, "coincident");
}

TEST(Extraction, SameBytesForAnyNumberOfThreads) {
  for (const Named& shape : shapes_to_try()) {
    const mesh::Surface s = shapes::scaled_surface(shape.mesh, 120);
    const std::vector<Vec3> sites = shapes::random_sites(s, 120, 8);
    const Extraction one = run(s, sites);
    for (const int threads : {2, 5}) {
      const Extraction many = run(s, sites, threads);
      EXPECT_EQ(one.mesh.triangles(), many.mesh.triangles());
      EXPECT_EQ(one.mesh.positions, many.mesh.positions);
      EXPECT_EQ(one.foot, many.foot);
    }
  }
}

TEST(LabelGuidedCollapse, TopologyByConstructionFromAnySites) {
  for (const Named& shape : shapes_to_try()) {
    for (const Index n : {25, 60, 300}) {
      const mesh::Surface s = shapes::scaled_surface(shape.mesh, n);
      numeric::Random random(n);
      std::vector<Vec3> sites;
      std::vector<Index> feet(n);
      for (Index i = 0; i < n; ++i) sites.push_back(shapes::random_point(s, random, &feet[i]));
      const rdt::CollapsedMesh c = rdt::label_guided_collapse(s, sites, feet);
      expect_topology(c.mesh, shape.mesh, n, shape.name);
    }
  }
}

TEST(Extraction, RealModels) {
  const std::string folder = NONOBTUSE_MODELS;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no models in " << folder;
  for (const char* file : {"paper/elk_3k.off", "paper/genus3.off", "smooth/fertility_igl.off"}) {
    const TriangleMesh m = clean(read_mesh(folder + "/" + file).mesh).mesh;
    for (const Index n : {60, 400}) {
      const mesh::Surface s = shapes::scaled_surface(m, n);
      expect_topology(run(s, shapes::random_sites(s, n, 3)).mesh, m, n, file);
    }
  }
}

}  // namespace
