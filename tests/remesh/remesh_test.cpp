// The one call, from a mesh to a certified one: what it promises on any input, and that scale,
// place, orientation and numbering of the input do not matter.
#include "nonobtuse/remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <vector>

#include "nonobtuse/quality.h"
#include "nonobtuse/sample.h"
#include "numeric/random.h"
#include "numeric/vec3.h"
#include "rdt/shapes.h"

namespace nonobtuse {
namespace {

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& shift) {
  for (Vec3& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

TriangleMesh rotated(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices)
    v = {0.36 * v.x + 0.48 * v.y - 0.8 * v.z, -0.8 * v.x + 0.6 * v.y,
         0.48 * v.x + 0.64 * v.y + 0.6 * v.z};
  return mesh;
}

// The same surface with vertices and triangles in another order.
TriangleMesh renumbered(const TriangleMesh& mesh) {
  numeric::Random random(7);
  std::vector<Index> place(mesh.vertices.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t i = place.size(); i-- > 1;) std::swap(place[i], place[random.below(i + 1)]);
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) result.vertices[place[v]] = mesh.vertices[v];
  for (Triangle& t : result.triangles) t = {place[t[1]], place[t[2]], place[t[0]]};
  std::reverse(result.triangles.begin(), result.triangles.end());
  return result;
}

TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<Index>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles)
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

void expect_promise(const TriangleMesh& input, Index n, const RemeshResult& result) {
  EXPECT_EQ(result.status, Status::Converged);
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_TRUE(certify(result.mesh, {40, 80}).certified);
  EXPECT_EQ(result.mesh.vertices.size(), n);
  const Topology before = measure_topology(input);
  const Topology after = measure_topology(result.mesh);
  EXPECT_EQ(after.vertices, n);
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
  EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  EXPECT_EQ(after.nonmanifold_edges, 0);
  EXPECT_EQ(after.nonmanifold_vertices, 0);
  EXPECT_TRUE(after.oriented);
  const QualityReport report = measure(result.mesh, &input);
  EXPECT_EQ(report.self_intersections, 0);
  EXPECT_EQ(report.flipped, 0);
}

TEST(RemeshCall, CertifiedWithTheTopologyOfTheInput) {
  const TriangleMesh input = sample_surface(24);
  for (const std::uint64_t seed : {1, 2}) {
    const RemeshResult result = remesh(input, {.vertices = 1200, .seed = seed});
    expect_promise(input, 1200, result);
  }
}

TEST(RemeshCall, VerticesLieWhereTheResultSays) {
  const TriangleMesh input = sample_surface(24);
  const RemeshResult result = remesh(input, {.vertices = 1000});
  const double h = std::sqrt(4 * M_PI / 1000) * 2;  // a generous edge length for extent about 1
  ASSERT_EQ(result.source_triangle.size(), result.mesh.vertices.size());
  ASSERT_EQ(result.barycentric.size(), result.mesh.vertices.size());
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    const Triangle& t = input.triangles.at(result.source_triangle[v]);
    const Vec3 b = result.barycentric[v];
    EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-9);
    EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
    const Vec3 p =
        b.x * input.vertices[t[0]] + b.y * input.vertices[t[1]] + b.z * input.vertices[t[2]];
    EXPECT_LT(distance(p, result.mesh.vertices[v]), h);
  }
}

TEST(RemeshCall, SameBytesForAnyNumberOfThreadsAndEveryRun) {
  const TriangleMesh input = sample_surface(24);
  const RemeshOptions options{.vertices = 900, .seed = 5};
  const RemeshResult one = remesh(input, options, {.threads = 1});
  for (const int threads : {1, 2, 5}) {
    const RemeshResult other = remesh(input, options, {.threads = threads});
    EXPECT_EQ(one.mesh.vertices, other.mesh.vertices) << threads;
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles) << threads;
  }
}

// Powers of two change no bit of a mantissa: the very same mesh comes out.
TEST(RemeshCall, ScalesByPowersOfTwoExactly) {
  const TriangleMesh input = sample_surface(20);
  const RemeshOptions options{.vertices = 600};
  const RemeshResult base = remesh(input, options);
  const RemeshResult scaled = remesh(moved(input, 1024, {}), options);
  EXPECT_EQ(scaled.mesh.vertices, moved(base.mesh, 1024, {}).vertices);
  EXPECT_EQ(scaled.mesh.triangles, base.mesh.triangles);
}

TEST(RemeshCall, QualityDoesNotDependOnScalePlaceOrNumbering) {
  const TriangleMesh input = sample_surface(20);
  const Vec3 far{1e6, -1e6, 1e6};
  for (const TriangleMesh& variant :
       {moved(input, 1e-6, {}), moved(input, 1e6, {}), moved(input, 1, far), rotated(input),
        renumbered(input), moved(input, 1e-150, {}), moved(input, 1e150, {})}) {
    const RemeshResult result = remesh(variant, {.vertices = 700});
    EXPECT_EQ(result.status, Status::Converged);
    EXPECT_EQ(result.mesh.vertices.size(), 700);
    EXPECT_GT(result.angles.quality_mean, 0.94);
    EXPECT_EQ(measure_topology(result.mesh).euler_characteristic, -4);
  }
}

TEST(Parts, NestedAndCrossingComponentsStayApart) {
  const TriangleMesh torus = shapes::torus(40, 24);
  const TriangleMesh nested = together(torus, shapes::torus(40, 24, 0.39));
  const TriangleMesh crossing = together(torus, moved(torus, 1, {0.5, 0.1, 0.05}));
  for (const TriangleMesh& input : {nested, crossing}) {
    const RemeshResult result = remesh(input, {.vertices = 1600});
    EXPECT_TRUE(result.certificate.certified);
    const Topology topology = measure_topology(result.mesh);
    EXPECT_EQ(topology.vertices, 1600);
    EXPECT_EQ(topology.components, 2);
    EXPECT_EQ(topology.euler_characteristic, 0);
    EXPECT_EQ(topology.nonmanifold_edges, 0);
  }
}

TEST(Parts, TakeVerticesByAreaButNeverTooFew) {
  const TriangleMesh torus = shapes::torus(24, 16);
  const TriangleMesh input = together(torus, moved(torus, 0.01, {5, 0, 0}));
  const RemeshResult result = remesh(input, {.vertices = 400});
  const Topology topology = measure_topology(result.mesh);
  EXPECT_EQ(topology.vertices, 400);
  EXPECT_EQ(topology.components, 2);
  EXPECT_EQ(topology.euler_characteristic, 0);  // the small torus still is one
}

TEST(Parts, ThatNeedMoreTakeThemFromTheLarge) {
  const TriangleMesh large = shapes::torus(24, 16);
  // By area a vertex or two would be the boxes' share; each has eight corners.
  const TriangleMesh input = together(together(moved(shapes::box(2, 2, 2), 0.01, {5, 0, 0}), large),
                                      moved(shapes::box(2, 2, 2), 0.02, {6, 0, 0}));
  const RemeshResult result = remesh(input, {.vertices = 300});
  const Topology topology = measure_topology(result.mesh);
  EXPECT_EQ(topology.vertices, 300);
  EXPECT_EQ(topology.components, 3);
  EXPECT_EQ(topology.euler_characteristic, 4);
  // A part's mesh depends on its number of vertices alone, whatever the others asked for.
  const std::vector<Vec3>& all = result.mesh.vertices;
  const auto in_large = [](const Vec3& p) { return p.x < 4; };
  const auto count = static_cast<Index>(std::count_if(all.begin(), all.end(), in_large));
  const auto first = std::find_if(all.begin(), all.end(), in_large);
  const RemeshResult alone = remesh(large, {.vertices = count});
  ASSERT_EQ(alone.mesh.vertices.size(), static_cast<std::size_t>(count));
  EXPECT_TRUE(std::equal(alone.mesh.vertices.begin(), alone.mesh.vertices.end(), first));
}

TEST(RemeshCall, TooFewVerticesAreRefusedWithTheNumberNeeded) {
  const TriangleMesh input = sample_surface(20);
  try {
    remesh(input, {.vertices = 5});
    FAIL() << "genus 3 with 5 vertices";
  } catch (const TooFewVertices& e) {
    EXPECT_GE(e.least(), 10);  // Heawood's bound for genus 3
    const RemeshResult result = remesh(input, {.vertices = e.least()});
    EXPECT_EQ(measure_topology(result.mesh).euler_characteristic, -4);
  }
}

TEST(RemeshCall, SenselessRequestsAreRefused) {
  const TriangleMesh input = sample_surface(20);
  EXPECT_THROW(remesh(input, {.vertices = -3}), InvalidInput);
  EXPECT_THROW(remesh(input, {.vertices = 100, .edge_length = 0.1}), InvalidInput);
  EXPECT_THROW(remesh(input, {.min_angle = 61}), InvalidInput);
  EXPECT_THROW(remesh(input, {.max_angle = 91}), InvalidInput);
  EXPECT_THROW(remesh(input, {.edge_length = NAN}), InvalidInput);
  EXPECT_THROW(remesh(TriangleMesh{}, {}), InvalidInput);
  EXPECT_THROW(remesh(moved(input, 1e-310, {}), {.vertices = 100}), InvalidInput);
  EXPECT_THROW(remesh(input, {.vertices = 200'000'000}), InvalidInput);
  EXPECT_THROW(remesh(input, {.vertices = 100, .method = Method::Cvt, .on_surface = true}),
               InvalidInput);
  EXPECT_THROW(remesh(input, {.method = Method::CvtFs, .normal_weight = 0.5}), InvalidInput);
  EXPECT_THROW(remesh(input, {.iterations = 10}), InvalidInput);
  EXPECT_THROW(remesh(input, {.method = Method::Cvt, .iterations = -1}), InvalidInput);
  TriangleMesh dirty = input;
  dirty.vertices.push_back({9, 9, 9});
  EXPECT_THROW(remesh(dirty, {.vertices = 100}), InvalidInput);
}

TEST(RemeshCall, EdgeLengthGivesAboutThatLength) {
  const TriangleMesh input = sample_surface(24);
  const RemeshResult result = remesh(input, {.relative_edge_length = 0.03});
  Vec3 low = input.vertices[0];
  Vec3 high = low;
  for (const Vec3& v : input.vertices) {
    low = min(low, v);
    high = max(high, v);
  }
  const double wanted = 0.03 * distance(low, high);
  double sum = 0;
  for (const Triangle& t : result.mesh.triangles)
    for (int k = 0; k < 3; ++k)
      sum += distance(result.mesh.vertices[t[k]], result.mesh.vertices[t[(k + 1) % 3]]);
  EXPECT_NEAR(sum / (3.0 * static_cast<double>(result.mesh.triangles.size())), wanted,
              0.1 * wanted);
}

// Whenever the caller stops it, a mesh with the right count and topology comes back.
TEST(RemeshCall, CancelledReturnsAValidMesh) {
  const TriangleMesh input = sample_surface(20);
  for (const double at : {0.0, 0.1, 0.45, 0.7, 0.9}) {
    Context context;
    double last = 0;
    context.progress = [&](const Progress& p) {
      EXPECT_GE(p.fraction, last);
      EXPECT_LE(p.fraction, 1);
      last = p.fraction;
      return p.fraction < at;
    };
    const RemeshResult result = remesh(input, {.vertices = 500}, context);
    EXPECT_EQ(result.status, Status::Cancelled);
    const Topology topology = measure_topology(result.mesh);
    EXPECT_EQ(topology.vertices, 500);
    EXPECT_EQ(topology.euler_characteristic, -4);
    EXPECT_EQ(topology.nonmanifold_edges, 0);
  }
}

}  // namespace
}  // namespace nonobtuse
