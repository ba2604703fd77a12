// The dual of the exact diagram: manifold and of the surface's topology where the closed-ball check
// says so, with and without ties.
#include "rdt/restricted_delaunay.h"

#include <gtest/gtest.h>

#include "rdt/closed_ball.h"
#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;

const parallel::Workers& serial() {
  static const parallel::Workers workers(1);
  return workers;
}

struct Dual {
  std::vector<Triangle> triangles;
  std::vector<rdt::DefectiveCell> defects;
};

Dual dual_of(const mesh::Surface& s, const std::vector<Vec3>& sites) {
  const auto diagram =
      rvd::restricted_voronoi(s, sites, rvd::facet_candidates(s, sites, serial()), serial());
  Dual d;
  d.triangles = rdt::restricted_delaunay(diagram, diagram.site);
  d.defects = rdt::closed_ball_defects(s, diagram, diagram.site, static_cast<Index>(sites.size()),
                                       d.triangles);
  return d;
}

mesh::Surface surface_of(const TriangleMesh& m) {
  return mesh::make_surface(m.vertices, m.triangles);
}

// Whatever the sites: no defect exactly if the dual is a mesh of the surface on all sites whose
// cells are discs. (The converse need not hold; few sites test the first half.)
TEST(RestrictedDelaunay, NoDefectMeansTheSurfacesTopology) {
  int valid = 0;
  int invalid = 0;
  const std::vector<TriangleMesh> inputs{shapes::sphere(3),    shapes::torus(24, 12),
                                         shapes::square(9),    shapes::cylinder(8, 16),
                                         shapes::box(3, 2, 4), shapes::torus(30, 8, 0.1)};
  for (const TriangleMesh& m : inputs) {
    shapes::Topology expected = shapes::topology(m.triangles);
    for (const Index n : {3, 4, 5, 8, 12, 20, 40, 80, 160, 400, 900}) {
      const mesh::Surface s = shapes::scaled_surface(m, n);
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        const Dual d = dual_of(s, shapes::random_sites(s, n, seed));
        shapes::Topology t = shapes::topology(d.triangles);
        expected.vertices = n;
        if (d.defects.empty()) {
          EXPECT_EQ(t, expected);
          ++valid;
        } else {
          ++invalid;
        }
      }
    }
  }
  EXPECT_GT(valid, 30);
  EXPECT_GT(invalid, 30);
}

TEST(RestrictedDelaunay, OrientedLikeTheSurface) {
  const mesh::Surface s = shapes::scaled_surface(shapes::sphere(4), 300);
  const std::vector<Vec3> sites = shapes::random_sites(s, 300, 1);
  for (const Triangle& t : dual_of(s, sites).triangles) {
    const Vec3 n = area_vector(sites[t[0]], sites[t[1]], sites[t[2]]);
    EXPECT_GT(dot(n, sites[t[0]] + sites[t[1]] + sites[t[2]]), 0);
  }
}

// Structured sites are full of exact ties: four and more cells meet at vertices, edges, inside.
TEST(RestrictedDelaunay, TiesGiveManifoldsInAnyOrder) {
  struct Tied {
    mesh::Surface surface;
    std::vector<Vec3> sites;
  };
  std::vector<Tied> all;
  const TriangleMesh grid = shapes::box(4, 4, 4);
  all.push_back({surface_of(grid), grid.vertices});
  TriangleMesh fine = shapes::box(12, 12, 12);
  for (Vec3& v : fine.vertices) v = v / 4.0;
  all.push_back({surface_of(fine), shapes::box(3, 3, 3).vertices});
  all.push_back({surface_of(shapes::sphere(4)), shapes::sphere(0).vertices});
  all.push_back({surface_of(shapes::sphere(4)), shapes::sphere(2).vertices});
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back({k & 1 ? 1. : -1., k & 2 ? 1. : -1., k & 4 ? 1. : -1.});
  all.push_back({surface_of(shapes::sphere(4)), corners});  // cells meet by fours at six points
  all.push_back({surface_of(shapes::square(16)), shapes::square(5).vertices});
  all.push_back({surface_of(shapes::square(15)), shapes::square(5).vertices});
  for (Tied& c : all) {
    const shapes::Topology expected = [&] {
      shapes::Topology t = shapes::topology(c.surface.triangles);
      t.vertices = static_cast<int>(c.sites.size());
      return t;
    }();
    numeric::Random random(9);
    for (int round = 0; round < 6; ++round) {
      const Dual d = dual_of(c.surface, c.sites);
      EXPECT_TRUE(d.defects.empty());
      EXPECT_EQ(shapes::topology(d.triangles), expected);
      for (std::size_t i = c.sites.size(); i > 1; --i)  // shuffle
        std::swap(c.sites[i - 1], c.sites[random.below(i)]);
    }
  }
}

// Triangles of the dual by plain floating-point clipping (Sutherland, Hodgman 1974) of every facet
// by every site: what the exact engine must give where no tie is near.
std::set<Triangle> floating_dual(const mesh::Surface& s, const std::vector<Vec3>& sites) {
  struct Point {
    Vec3 at;
    Index side;  // what lies across the side that begins here; < 0 for a facet's edge
  };
  std::set<Triangle> result;
  for (const Triangle& t : s.triangles) {
    for (Index i = 0; i < static_cast<Index>(sites.size()); ++i) {
      std::vector<Point> polygon{
          {s.vertices[t[0]], -1}, {s.vertices[t[1]], -2}, {s.vertices[t[2]], -3}};
      for (Index j = 0; j < static_cast<Index>(sites.size()) && !polygon.empty(); ++j) {
        if (j == i) continue;
        const auto value = [&](const Vec3& p) {
          return squared_distance(p, sites[i]) - squared_distance(p, sites[j]);
        };
        std::vector<Point> kept;
        for (std::size_t m = 0; m < polygon.size(); ++m) {
          const Point& a = polygon[m];
          const Point& b = polygon[(m + 1) % polygon.size()];
          const double va = value(a.at);
          const double vb = value(b.at);
          if (va <= 0) kept.push_back(a);
          if ((va <= 0) != (vb <= 0))
            kept.push_back({a.at + va / (va - vb) * (b.at - a.at), va <= 0 ? j : a.side});
        }
        polygon = std::move(kept);
      }
      for (std::size_t m = 0; m < polygon.size(); ++m) {
        const Index after = polygon[m].side;
        const Index before = polygon[(m + polygon.size() - 1) % polygon.size()].side;
        if (before > i && after > i) result.insert({i, before, after});
      }
    }
  }
  return result;
}

TEST(RestrictedDelaunay, EqualsFloatingPointWhereNoTieIsNear) {
  for (const TriangleMesh& m : {shapes::sphere(3), shapes::torus(20, 10), shapes::square(7)}) {
    const mesh::Surface s = shapes::scaled_surface(m, 70);
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const std::vector<Vec3> sites = shapes::random_sites(s, 70, seed);
      const std::vector<Triangle> exact = dual_of(s, sites).triangles;
      EXPECT_EQ(std::set<Triangle>(exact.begin(), exact.end()), floating_dual(s, sites));
    }
  }
}

TEST(ClosedBall, NamesWhatIsWrong) {
  const auto kinds = [](const mesh::Surface& s, const std::vector<Vec3>& sites) {
    std::set<rdt::CellDefect> result;
    for (const auto& d : dual_of(s, sites).defects) result.insert(d.kind);
    return result;
  };
  using rdt::CellDefect;
  const mesh::Surface torus = surface_of(shapes::torus(24, 12));
  EXPECT_EQ(kinds(torus, {{1.4, 0, 0}}), std::set{CellDefect::Handle});
  // Three around the ring: annuli.
  EXPECT_EQ(kinds(torus, {{1, 0, 0.4}, {-0.5, 0.8, 0.4}, {-0.5, -0.8, 0.4}}),
            std::set{CellDefect::Handle});
  const mesh::Surface sphere = surface_of(shapes::sphere(3));
  EXPECT_EQ(kinds(sphere, {{0, 0, 1}, {0, 0, -1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}),
            std::set{CellDefect::Empty});
  EXPECT_EQ(kinds(sphere, {{0, 0, 1}, {0, 0, -1}}), std::set{CellDefect::DoubleEdge});
  // Two parallel sheets and sites on the upper one: each cell has two pieces.
  const auto twice = [](int part) {
    TriangleMesh m = shapes::square(6);
    const Index n = static_cast<Index>(m.vertices.size());
    for (Index v = 0; part == 2 && v < n; ++v)
      m.vertices.push_back(m.vertices[v] - Vec3{0, 0, 0.1});
    const std::size_t count = m.triangles.size();
    for (std::size_t t = 0; part == 2 && t < count; ++t) {
      const Triangle c = m.triangles[t];
      m.triangles.push_back({c[0] + n, c[2] + n, c[1] + n});
    }
    return surface_of(m);
  };
  const std::vector<Vec3> sites = shapes::square(2).vertices;
  EXPECT_TRUE(kinds(twice(1), sites).empty());
  EXPECT_EQ(kinds(twice(2), sites), std::set{CellDefect::Pieces});
}

}  // namespace
