// The exact diagram against brute force: who is nearest, areas, and how pieces fit together.
#include "rvd/restricted_voronoi.h"

#include <gtest/gtest.h>

#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;
using namespace nonobtuse::rvd;

struct Case {
  std::string name;
  mesh::Surface surface;
  std::vector<Vec3> sites;
};

// Random, structured and degenerate site sets.
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](std::string name, const TriangleMesh& m, std::vector<Vec3> sites) {
    all.push_back({std::move(name), mesh::make_surface(m.vertices, m.triangles), std::move(sites)});
  };
  const auto random = [&](std::string name, const TriangleMesh& m, Index n) {
    const mesh::Surface s = shapes::scaled_surface(m, n);
    all.push_back({std::move(name), s, shapes::random_sites(s, n, 11)});
  };
  random("random on sphere, few", shapes::sphere(3), 5);
  random("random on sphere, many", shapes::sphere(1), 300);
  random("random on torus", shapes::torus(20, 10), 60);
  random("random on square", shapes::square(6), 40);
  random("one site", shapes::torus(6, 5), 1);
  const TriangleMesh cube = shapes::box(4, 4, 4);
  add("cube, sites at all vertices", cube, cube.vertices);
  add("coarse cube, grid sites", shapes::box(1, 1, 1), [&] {
    std::vector<Vec3> sites;
    for (const Vec3& v : cube.vertices) sites.push_back(0.25 * v);
    return sites;
  }());
  std::vector<Vec3> centres;
  for (const Triangle& t : cube.triangles)
    centres.push_back(0.5 * (cube.vertices[t[0]] + cube.vertices[t[2]]));  // on edges, some twice
  add("cube, sites on edges, coincident", cube, centres);
  const TriangleMesh sphere = shapes::sphere(3);
  add("sphere, vertices of the octahedron", sphere, shapes::sphere(0).vertices);
  add("sphere, all vertices", sphere, sphere.vertices);
  add("sphere, sites at its centre", sphere, {{}, {}, {}});
  add("square, grid", shapes::square(8), shapes::square(5).vertices);
  add("square, on a line", shapes::square(8),
      {{0.125, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0}, {0.75, 0.5, 0}});
  TriangleMesh flat = shapes::square(4);
  for (Vec3& v : flat.vertices)
    if (v.x < 0.3) v.x = 0;  // a row of facets without area
  add("some facets without area", flat, shapes::square(2).vertices);
  return all;
}

const parallel::Workers& serial() {
  static const parallel::Workers workers(1);
  return workers;
}

RestrictedVoronoi diagram_of(const Case& c) {
  return restricted_voronoi(c.surface, c.sites, facet_candidates(c.surface, c.sites, serial()),
                            serial());
}

FacetCandidates everybody(const Case& c) {
  FacetCandidates all;
  all.start.push_back(0);
  for (std::size_t f = 0; f < c.surface.triangles.size(); ++f) {
    for (std::size_t i = 0; i < c.sites.size(); ++i) all.sites.push_back(static_cast<Index>(i));
    all.start.push_back(static_cast<Index>(all.sites.size()));
  }
  return all;
}

TEST(RestrictedVoronoi, CandidateListsLoseNothing) {
  for (const Case& c : cases()) {
    if (c.sites.size() > 120) continue;
    const RestrictedVoronoi fast = diagram_of(c);
    const RestrictedVoronoi all = restricted_voronoi(c.surface, c.sites, everybody(c), serial());
    EXPECT_EQ(fast.facet_start, all.facet_start) << c.name;
    EXPECT_EQ(fast.site, all.site) << c.name;
    // The sides may begin elsewhere in the cycle: compare from the least on.
    ASSERT_EQ(fast.side_start, all.side_start) << c.name;
    for (Index p = 0; p < fast.piece_count(); ++p) {
      std::vector<Side> a(fast.sides_of(p).begin(), fast.sides_of(p).end());
      std::vector<Side> b(all.sides_of(p).begin(), all.sides_of(p).end());
      std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
      std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
      ASSERT_EQ(a, b) << c.name;
    }
  }
}

TEST(RestrictedVoronoi, AreasSumToTheFacet) {
  for (const Case& c : cases()) {
    const RestrictedVoronoi d = diagram_of(c);
    std::vector<Vec3> corners;
    for (Index f = 0; f < static_cast<Index>(c.surface.triangles.size()); ++f) {
      double sum = 0;
      for (Index p = d.facet_start[f]; p < d.facet_start[f + 1]; ++p) {
        corner_positions(c.surface, c.sites, d, f, p, corners);
        ASSERT_GE(corners.size(), 3U);
        for (std::size_t m = 1; m + 1 < corners.size(); ++m)
          sum +=
              0.5 * dot(area_vector(corners[0], corners[m], corners[m + 1]), c.surface.normals[f]);
      }
      ASSERT_NEAR(sum, c.surface.areas[f], 1e-10 * (1 + c.surface.areas[f])) << c.name;
    }
    const CellSums cells = cell_sums(c.surface, c.sites, d, d.site);
    EXPECT_NEAR(std::accumulate(cells.mass.begin(), cells.mass.end(), 0.0), c.surface.area,
                1e-9 * c.surface.area + 1e-300)
        << c.name;
  }
}

TEST(RestrictedVoronoi, RandomPointsLieInThePieceOfTheirNearestSite) {
  for (const Case& c : cases()) {
    const RestrictedVoronoi d = diagram_of(c);
    numeric::Random random(5);
    std::vector<Vec3> corners;
    for (int sample = 0; sample < 400; ++sample) {
      Index f = 0;
      const Vec3 p = shapes::random_point(c.surface, random, &f);
      Index nearest = 0;  // the lowest index of the nearest
      for (Index i = 1; i < static_cast<Index>(c.sites.size()); ++i)
        if (squared_distance(p, c.sites[i]) < squared_distance(p, c.sites[nearest]) - 1e-12)
          nearest = i;
      const Index piece = d.find(f, nearest);
      double second = 1e300;
      for (Index i = 0; i < static_cast<Index>(c.sites.size()); ++i)
        if (i != nearest) second = std::min(second, squared_distance(p, c.sites[i]));
      // Too near a bisector to tell (coincident sites excepted: there the lower index owns all).
      const double gap = second - squared_distance(p, c.sites[nearest]);
      if (gap < 1e-9 && gap > 0) continue;
      if (gap == 0 && c.name.find("coincident") == std::string::npos &&
          c.name.find("centre") == std::string::npos)
        continue;
      ASSERT_GE(piece, 0) << c.name;
      corner_positions(c.surface, c.sites, d, f, piece, corners);
      for (std::size_t m = 0; m < corners.size(); ++m) {
        const Vec3 n = area_vector(p, corners[m], corners[(m + 1) % corners.size()]);
        EXPECT_GE(dot(n, c.surface.normals[f]), -1e-9) << c.name;
      }
    }
  }
}

// What exactness is for: pieces meet side to side, in and across facets, in every case.
TEST(RestrictedVoronoi, PiecesFitTogether) {
  for (const Case& c : cases()) {
    const RestrictedVoronoi d = diagram_of(c);
    for (Index f = 0; f < static_cast<Index>(c.surface.triangles.size()); ++f) {
      ASSERT_GT(d.facet_start[f + 1], d.facet_start[f]) << c.name;
      for (Index p = d.facet_start[f]; p < d.facet_start[f + 1]; ++p) {
        const auto sides = d.sides_of(p);
        const std::size_t count = sides.size();
        ASSERT_GE(count, 3U);
        for (std::size_t m = 0; m < count; ++m) {
          const Side s = sides[m];
          const Side before = sides[(m + count - 1) % count];
          const Side after = sides[(m + 1) % count];
          if (!is_edge(s)) {
            // The neighbour has the same side, running backwards.
            const Index q = d.find(f, s);
            ASSERT_GE(q, 0) << c.name;
            const auto other = d.sides_of(q);
            const auto it = std::find(other.begin(), other.end(), d.site[p]);
            ASSERT_NE(it, other.end()) << c.name;
            const std::size_t at = it - other.begin();
            EXPECT_EQ(other[(at + 1) % other.size()], before);
            EXPECT_EQ(other[(at + other.size() - 1) % other.size()], after);
            continue;
          }
          if (c.surface.adjacent[f][edge_of(s)] < 0) continue;
          const Index q = d.across(c.surface, f, p, edge_of(s));
          ASSERT_GE(q, 0) << c.name;
          // Same interval of the edge: bisectors at its ends agree.
          const Index g = c.surface.adjacent[f][edge_of(s)];
          int k = 0;
          while (c.surface.adjacent[g][k] != f) ++k;
          const auto other = d.sides_of(q);
          const auto it = std::find(other.begin(), other.end(), edge_side(k));
          ASSERT_NE(it, other.end()) << c.name;
          const std::size_t at = it - other.begin();
          const Side other_after = other[(at + 1) % other.size()];
          const Side other_before = other[(at + other.size() - 1) % other.size()];
          EXPECT_EQ(is_edge(before), is_edge(other_after)) << c.name;
          EXPECT_EQ(is_edge(after), is_edge(other_before)) << c.name;
          if (!is_edge(before)) {
            EXPECT_EQ(before, other_after) << c.name;
          }
          if (!is_edge(after)) {
            EXPECT_EQ(after, other_before) << c.name;
          }
        }
      }
    }
  }
}

TEST(RestrictedVoronoi, DualEdgesOfAGridHaveTheirLengths) {
  // Sites at the centres of a 4 x 4 grid of unit squares: cells are the squares.
  TriangleMesh m = shapes::square(5);
  for (Vec3& v : m.vertices) v *= 4;
  const mesh::Surface s = mesh::make_surface(m.vertices, m.triangles);
  std::vector<Vec3> sites;
  for (int i = 0; i < 16; ++i) sites.push_back({0.5 + i / 4, 0.5 + i % 4, 0});
  const RestrictedVoronoi d =
      restricted_voronoi(s, sites, facet_candidates(s, sites, serial()), serial());
  int unit = 0;
  for (const DualEdge& e : dual_edges(s, sites, d)) {
    if (distance(sites[e.site], sites[e.other]) < 1.1) {
      EXPECT_NEAR(e.length, 1, 1e-12);
      ++unit;
    } else {
      EXPECT_NEAR(e.length, 0, 1e-12);  // diagonal of an exact tie
    }
  }
  EXPECT_EQ(unit, 24);
}

TEST(RestrictedVoronoi, TheSameForAnyNumberOfThreads) {
  const mesh::Surface s = shapes::scaled_surface(shapes::torus(80, 40), 500);
  const std::vector<Vec3> sites = shapes::random_sites(s, 500, 2);
  const RestrictedVoronoi one =
      restricted_voronoi(s, sites, facet_candidates(s, sites, serial()), serial());
  for (const int threads : {2, 5}) {
    const parallel::Workers workers(threads);
    const RestrictedVoronoi many =
        restricted_voronoi(s, sites, facet_candidates(s, sites, workers), workers);
    EXPECT_EQ(one.site, many.site);
    EXPECT_EQ(one.sides, many.sides);
    EXPECT_EQ(one.facet_start, many.facet_start);
  }
}

}  // namespace
