// Detection of creases, the graph they form, shares of vertices, cutting, and the whole call on
// surfaces with creases and boundaries.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "features/crease_detection.h"
#include "features/facet_splitting.h"
#include "features/feature_graph.h"
#include "features/knot_insertion.h"
#include "features/narrow_places.h"
#include "features/vertex_balance.h"
#include "nonobtuse/io.h"
#include "nonobtuse/remesh.h"
#include "rdt/shapes.h"

namespace nonobtuse::features {
namespace {

mesh::Surface surface_of(const TriangleMesh& m) {
  return mesh::make_surface(m.vertices, m.triangles);
}

EdgeFlags creases_of(const mesh::Surface& s) {
  EdgeFlags flags(s.triangles.size(), 0);
  detect_creases(s, flags);
  return flags;
}

// Every flag is one side of an edge of two facets.
Index count_edges(const EdgeFlags& flags) {
  Index sides = 0;
  for (const std::uint8_t f : flags) sides += (f & 1) + (f >> 1 & 1) + (f >> 2 & 1);
  return sides / 2;
}

TriangleMesh can(int columns) {  // a cylinder with both lids
  TriangleMesh m = shapes::cylinder(6, columns);
  const auto last = static_cast<Index>(m.vertices.size());
  m.vertices.push_back({0, 0, 0});
  m.vertices.push_back({0, 0, 2});
  for (int j = 0; j < columns; ++j) {
    const int k = (j + 1) % columns;
    m.triangles.push_back({j, k, last});
    m.triangles.push_back({6 * columns + k, 6 * columns + j, last + 1});
  }
  for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
  return clean(m).mesh;
}

TEST(Creases, OfABoxAreItsEdges) {
  const mesh::Surface s = surface_of(shapes::box(2, 3, 4));
  const EdgeFlags flags = creases_of(s);
  EXPECT_EQ(count_edges(flags), 4 * (2 + 3 + 4));
  const FeatureGraph graph = feature_graph(s, flags, {});
  EXPECT_EQ(graph.curves.size(), 12u);
  EXPECT_EQ(graph.corner_count(), 8);
}

TEST(Creases, OfACanAreItsRims) {
  for (const int columns : {12, 24, 64}) {
    const mesh::Surface s = surface_of(can(columns));
    const FeatureGraph graph = feature_graph(s, creases_of(s), {});
    ASSERT_EQ(graph.curves.size(), 2u) << columns;
    EXPECT_TRUE(graph.curves[0].closed && graph.curves[1].closed);
    EXPECT_EQ(graph.curves[0].vertices.size(), static_cast<std::size_t>(columns));
  }
}

TEST(Creases, RoundAndNoisySurfacesHaveNone) {
  for (const int levels : {1, 2, 4}) {
    const mesh::Surface s = surface_of(shapes::sphere(levels));
    EXPECT_EQ(count_edges(creases_of(s)), 0) << levels;
  }
  TriangleMesh noisy = shapes::sphere(4);
  numeric::Random random(7, 0);
  for (Vec3& v : noisy.vertices) v = (1 + 0.06 * random.uniform()) * v;
  EXPECT_EQ(count_edges(creases_of(surface_of(noisy))), 0);
  EXPECT_EQ(count_edges(creases_of(surface_of(shapes::torus(12, 8)))), 0);
}

TEST(Creases, RealSurfacesHaveThemOrNot) {
  const std::string folder = NONOBTUSE_MODELS;
  if (!std::filesystem::exists(folder + "/cad")) GTEST_SKIP() << "models not found in " << folder;
  const auto creases = [&](const char* name) {
    return count_edges(creases_of(surface_of(clean(read_mesh(folder + name).mesh).mesh)));
  };
  for (const char* name :
       {"/paper/homer.obj", "/paper/elk_10k.off", "/paper/elk_3k.off", "/paper/genus3.off",
        "/smooth/elephant_cgal.off", "/smooth/fertility_igl.off", "/smooth/maxplanck_dec.obj",
        "/smooth/spot_os.obj", "/open/head_cgal.off"})
    EXPECT_EQ(creases(name), 0) << name;
  for (const char* name :
       {"/paper/joint_446.off", "/cad/fandisk.obj", "/cad/anchor.off", "/cad/couplingdown.off",
        "/cad/cross.off", "/cad/pinion.off", "/cad/rotor_small.off"})
    EXPECT_GT(creases(name), 20) << name;
}

TEST(FeatureGraph, ASharpTurnOfABoundaryIsACorner) {
  const mesh::Surface s = surface_of(shapes::square(8));
  EdgeFlags flags(s.triangles.size(), 0);
  flag_boundaries(s.triangles, static_cast<Index>(s.vertices.size()), flags);
  FeatureGraph graph = feature_graph(s, flags, {});
  ASSERT_EQ(graph.curves.size(), 1u);
  EXPECT_TRUE(graph.curves[0].closed && graph.curves[0].boundary);
  graph = feature_graph(s, flags, sharp_turns(s, graph, 0.1));
  EXPECT_EQ(graph.curves.size(), 4u);
  for (Index v = 0; v < static_cast<Index>(s.vertices.size()); ++v) {
    const Vec3& p = s.vertices[v];
    EXPECT_EQ(graph.corner[v] == 1, (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1));
  }
}

TEST(VertexBalance, AddsUpExactly) {
  numeric::Random random(3, 0);
  for (int trial = 0; trial < 200; ++trial) {
    const Index patches = 1 + static_cast<Index>(5 * random.uniform());
    std::vector<PatchDemand> p(patches);
    double area = 0;
    for (PatchDemand& d : p) area += d.area = std::exp(6 * random.uniform());
    std::vector<CurveDemand> c(static_cast<std::size_t>(1 + 8 * random.uniform()));
    Index corners = 2;
    Index least = 2;
    for (CurveDemand& d : c) {
      d.length = 4 * std::sqrt(area) * random.uniform();
      d.closed = random.uniform() < 0.3;
      d.least = d.closed ? 3 : 1;
      least += d.closed ? 3 : 0;
      for (int s = 0; s < 2; ++s)
        d.patches.push_back(std::min(patches - 1, static_cast<Index>(patches * random.uniform())));
    }
    const auto n = least + static_cast<Index>(1000 * random.uniform());
    const VertexBalance balance = balance_vertices(c, p, corners, n);
    Index sum = corners;
    for (std::size_t i = 0; i < c.size(); ++i) {
      EXPECT_GE(balance.segments[i], c[i].least);
      sum += balance.segments[i] - (c[i].closed ? 0 : 1);
    }
    for (const Index v : balance.interior) {
      EXPECT_GE(v, 0);
      sum += v;
    }
    EXPECT_EQ(sum, n);
    EXPECT_THROW(balance_vertices(c, p, corners, least - 1), TooFewVertices);
  }
}

// Area of triangles, and every copy of a knot in the place of the knot.
TEST(CutOpen, KnotsAreVerticesAndGluingIsTheIdentity) {
  for (const TriangleMesh& m : {shapes::box(2, 3, 2), can(16), shapes::square(3)}) {
    const mesh::Surface s = surface_of(m);
    EdgeFlags flags = creases_of(s);
    flag_boundaries(s.triangles, static_cast<Index>(s.vertices.size()), flags);
    const FeatureGraph graph = feature_graph(s, flags, {});
    const std::vector<Index> segments(graph.curves.size(), 11);
    const KnottedSurface knotted =
        insert_knots(s, flags, graph, segments, {}, 0.01, static_cast<Index>(s.vertices.size()));
    Index expected = graph.corner_count();
    for (const FeatureCurve& c : graph.curves) expected += c.closed ? 11 : 10;
    EXPECT_EQ(static_cast<Index>(knotted.network.knots.size()), expected);
    const CutSurface cut = cut_open(knotted);
    EXPECT_NEAR(cut.surface.area, s.area, 1e-12 * s.area);
    ASSERT_EQ(cut.surface.triangles.size(), knotted.triangles.size());
    for (std::size_t t = 0; t < knotted.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Index copy = cut.surface.triangles[t][k];
        const Index v = knotted.triangles[t][k];
        EXPECT_EQ(cut.surface.vertices[copy], knotted.vertices[v]);
        EXPECT_EQ(cut.knot[copy], knotted.knot[v]);
        // Cut exactly along the features.
        EXPECT_EQ(cut.surface.adjacent[t][k] < 0, flagged(knotted.flags, static_cast<Index>(t), k));
      }
    for (std::size_t v = 0; v < knotted.vertices.size(); ++v) {
      if (knotted.knot[v] < 0) continue;
      const mesh::Knot& knot = knotted.network.knots[knotted.knot[v]];
      if (knot.curve < 0) continue;
      EXPECT_LT(
          distance(point_at(knotted.network.curves[knot.curve], knot.arc), knotted.vertices[v]),
          1e-12);
    }
  }
}

TEST(NarrowPlaces, AStripIsAsWideAsItIs) {
  // A strip of 1 by 20, resolved; its short sides are 1 long.
  TriangleMesh m = shapes::square(1);
  for (Vec3& v : m.vertices) v.x *= 20;
  const mesh::Surface s = surface_of(m);
  EdgeFlags flags(s.triangles.size(), 0);
  flag_boundaries(s.triangles, static_cast<Index>(s.vertices.size()), flags);
  const ResolvedSurface fine = resolve_surface(s, flags, 2, 0.5);
  std::vector<char> corners(fine.surface.vertices.size(), 0);
  std::fill_n(corners.begin(), s.vertices.size(), 1);
  const FeatureGraph graph = feature_graph(fine.surface, fine.flags, corners);
  ASSERT_EQ(graph.curves.size(), 4u);
  const std::vector<double> bounds = narrow_places(fine.surface, fine.flags, graph, 2);
  for (std::size_t v = 0; v < bounds.size(); ++v) {
    const Vec3& p = fine.surface.vertices[v];
    if ((p.y == 0 || p.y == 1) && p.x > 3 && p.x < 17) {
      EXPECT_NEAR(bounds[v], 0.7, 1e-9);
    }
  }
  // Edges much shorter than the strip is wide do not care.
  for (const double b : narrow_places(fine.surface, fine.flags, graph, 0.5)) EXPECT_GT(b, 0.5);
}

// A square plate 8 wide with right-angled rims.
TriangleMesh plate(double thickness) {
  TriangleMesh m = shapes::box(8, 8, 1);
  for (Vec3& v : m.vertices) v.z *= thickness;
  return m;
}

TEST(NarrowPlaces, CreasesNearerThanTheWidthBecomeOne) {
  const mesh::Surface s = surface_of(plate(0.1));
  EdgeFlags flags = creases_of(s);
  const FeatureGraph graph = feature_graph(s, flags, {});
  ASSERT_EQ(graph.curves.size(), 12u);
  // Nothing is nearer than the plate is thick.
  const EdgeFlags before = flags;
  EXPECT_FALSE(merge_close_curves(s, graph, 0.09, flags));
  EXPECT_EQ(flags, before);
  // One of the two rims goes, with stubs of one side at its corners.
  EXPECT_TRUE(merge_close_curves(s, graph, 0.2, flags));
  double low = 0, high = 0;
  for (Index f = 0; f < static_cast<Index>(flags.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      if (!flagged(flags, f, k)) continue;
      const Vec3& a = s.vertices[s.triangles[f][mesh::next(k)]];
      const Vec3& b = s.vertices[s.triangles[f][mesh::previous(k)]];
      if (a.z == b.z) (a.z == 0 ? low : high) += distance(a, b) / 2;
    }
  EXPECT_NEAR(std::max(low, high), 4 * 8, 1e-9);
  EXPECT_LE(std::min(low, high), 8);
}

// ---- the whole call ----

// Far thinner than an edge is long: the rims cannot both be kept with good angles.
TEST(FeatureRemesh, ThinPlatesKeepTheirTopologyAndThePromise) {
  for (const double part : {1e-1, 1e-2, 1e-4}) {
    SCOPED_TRACE(part);
    const Index n = 300;
    const double h = std::sqrt(2 / std::sqrt(3.0) * 2 * 64 / n);
    const RemeshResult result = remesh(plate(part * h), {.vertices = n});
    EXPECT_EQ(result.mesh.vertices.size(), static_cast<std::size_t>(n));
    const Topology topology = measure_topology(result.mesh);
    EXPECT_EQ(topology.euler_characteristic, 2);
    EXPECT_EQ(topology.boundary_loops, 0);
    EXPECT_EQ(topology.nonmanifold_edges, 0);
    EXPECT_TRUE(certify(result.mesh, {30, 90}).certified);
  }
}

std::set<std::array<Index, 2>> edges_of(const TriangleMesh& m) {
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : m.triangles)
    for (int k = 0; k < 3; ++k)
      edges.insert({std::min(t[k], t[mesh::next(k)]), std::max(t[k], t[mesh::next(k)])});
  return edges;
}

TEST(FeatureRemesh, ABoxKeepsItsCornersAndEdges) {
  TriangleMesh box = shapes::box(2, 3, 4);
  for (Vec3& v : box.vertices) v = {v.x / 3, v.y / 3, v.z / 3};
  const RemeshResult result = remesh(box, {.vertices = 600});
  EXPECT_EQ(result.status, Status::Converged);
  ASSERT_EQ(result.mesh.vertices.size(), 600u);
  const auto at = [](double x, double low, double high) { return x == low || x == high; };
  Index corners = 0;
  double length = 0;
  for (const Vec3& v : result.mesh.vertices)
    if (at(v.x, 0, 2.0 / 3) && at(v.y, 0, 1) && at(v.z, 0, 4.0 / 3)) ++corners;
  EXPECT_EQ(corners, 8);
  const auto edges = edges_of(result.mesh);
  for (const auto& e : result.feature_edges) {
    EXPECT_TRUE(edges.count(e));
    length += distance(result.mesh.vertices[e[0]], result.mesh.vertices[e[1]]);
  }
  EXPECT_NEAR(length, 4 * (2.0 / 3 + 1 + 4.0 / 3), 1e-9);
}

TEST(FeatureRemesh, SameBytesForAnyThreads) {
  const TriangleMesh input = can(24);
  Context one, five;
  one.threads = 1;
  five.threads = 5;
  const RemeshResult a = remesh(input, {.vertices = 500}, one);
  const RemeshResult b = remesh(input, {.vertices = 500}, five);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
}

// Boundary edges of a mesh, as end points.
Index boundary_loops(const TriangleMesh& m) { return measure_topology(m).boundary_loops; }

TEST(FeatureRemesh, FrozenBoundariesStayBitForBit) {
  for (const TriangleMesh& input : {shapes::square(9), shapes::cylinder(8, 20)}) {
    RemeshOptions options{.vertices = 400};
    options.boundary = Boundary::Freeze;
    const RemeshResult result = remesh(input, options);
    ASSERT_EQ(result.mesh.vertices.size(), 400u);
    EXPECT_EQ(boundary_loops(result.mesh), boundary_loops(input));
    const auto boundary = [](const TriangleMesh& m) {
      const auto adjacent =
          mesh::triangle_adjacency(m.triangles, static_cast<Index>(m.vertices.size()));
      std::set<std::array<double, 3>> points;
      for (std::size_t t = 0; t < m.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
          if (adjacent[t][k] >= 0) continue;
          const Vec3& p = m.vertices[m.triangles[t][mesh::next(k)]];
          points.insert({p.x, p.y, p.z});
        }
      return points;
    };
    EXPECT_EQ(boundary(result.mesh), boundary(input));
  }
}

TEST(FeatureRemesh, TooFewVerticesNamesANumberThatDoes) {
  const TriangleMesh box = shapes::box(1, 1, 1);
  Index least = 0;
  try {
    remesh(box, {.vertices = 5});
    FAIL() << "five vertices cannot do";
  } catch (const TooFewVertices& error) {
    least = error.least();
  }
  EXPECT_EQ(remesh(box, {.vertices = least}).mesh.vertices.size(), static_cast<std::size_t>(least));
}

TEST(FeatureRemesh, GivenEdgesAreKept) {
  const TriangleMesh input = shapes::square(4);
  RemeshOptions options{.vertices = 300};
  options.features = Features::Given;
  for (Index v = 10; v < 14; ++v) options.feature_edges.push_back({v, v + 1});
  const RemeshResult result = remesh(input, options);
  double length = 0;
  for (const auto& e : result.feature_edges)
    length += distance(result.mesh.vertices[e[0]], result.mesh.vertices[e[1]]);
  EXPECT_NEAR(length, 5, 1e-9);  // four sides, and the line across
  options.feature_edges.push_back({0, 24});
  EXPECT_THROW(remesh(input, options), InvalidInput);
}

}  // namespace
}  // namespace nonobtuse::features
