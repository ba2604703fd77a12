// Cells of a thin body: connected, on the sheet of their site, nothing lost.
#include "rvd/localized_cells.h"

#include <gtest/gtest.h>

#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;
using namespace nonobtuse::rvd;

struct Case {
  mesh::Surface surface;
  std::vector<Vec3> sites;
  RestrictedVoronoi diagram;
  std::vector<Index> feet;
  LocalizedCells cells;
};

Case make(TriangleMesh m, Index n, std::uint64_t seed) {
  const parallel::Workers serial(1);
  Case c;
  c.surface = shapes::scaled_surface(std::move(m), n);
  c.sites = shapes::random_sites(c.surface, n, seed);
  c.diagram =
      restricted_voronoi(c.surface, c.sites, facet_candidates(c.surface, c.sites, serial), serial);
  c.feet = cell_feet(c.surface, c.sites, c.diagram);
  c.cells = localized_cells(c.surface, c.sites, c.diagram, c.feet);
  return c;
}

TriangleMesh plate() {
  TriangleMesh m = shapes::box(20, 20, 1);
  for (Vec3& v : m.vertices) v.z *= 0.01;
  return m;
}

TEST(LocalizedCells, EveryCellIsConnectedAndHoldsItsSite) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    for (const TriangleMesh& m : {plate(), shapes::torus(40, 6, 0.03), shapes::sphere(3)}) {
      const Case c = make(m, 80, seed);
      const CellComponents parts = cell_components(c.surface, c.diagram, c.cells.owner);
      std::vector<int> count(c.sites.size(), 0);
      for (const Index i : parts.owner) ++count[i];
      for (std::size_t i = 0; i < c.sites.size(); ++i) {
        EXPECT_EQ(count[i], 1);
        const Index p = c.diagram.find(c.feet[i], static_cast<Index>(i));
        ASSERT_GE(p, 0);
        EXPECT_EQ(c.cells.owner[p], static_cast<Index>(i));
      }
      const CellSums sums = cell_sums(c.surface, c.sites, c.diagram, c.cells.owner);
      EXPECT_NEAR(std::accumulate(sums.mass.begin(), sums.mass.end(), 0.0), c.surface.area,
                  1e-9 * c.surface.area);
    }
  }
}

TEST(LocalizedCells, AThinPlateHasOrphansAndAFatSphereNone) {
  EXPECT_GT(make(plate(), 80, 1).cells.orphans, 10);
  EXPECT_EQ(make(shapes::sphere(4), 300, 1).cells.orphans, 0);
}

TEST(LocalizedCells, FeetAreTheNearestFacetsOfTheCell) {
  const Case c = make(shapes::sphere(3), 60, 2);
  for (std::size_t i = 0; i < c.sites.size(); ++i) {
    const Triangle& t = c.surface.triangles[c.feet[i]];
    const double height = dot(c.surface.normals[c.feet[i]], c.sites[i] - c.surface.vertices[t[0]]);
    EXPECT_NEAR(height, 0, 1e-9);  // the sites lie on the surface
  }
}

}  // namespace
