// `clean` gives a manifold, oriented surface of the same shape or says why it cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "mesh/degenerate_faces.h"
#include "nonobtuse/io.h"
#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse {
namespace {

// A torus of m by n quads, two triangles each: closed, 3 vertices of any face distinct.
TriangleMesh torus(Index m = 8, Index n = 6) {
  TriangleMesh mesh;
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < n; ++j) {
      const double a = 6.283185307179586 * i / m;
      const double b = 6.283185307179586 * j / n;
      const double r = 3 + std::cos(b);
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
    }
  const auto at = [&](Index i, Index j) { return (i % m) * n + j % n; };
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

struct EdgeUse {
  int forward = 0;
  int backward = 0;
};

std::map<std::pair<Index, Index>, EdgeUse> edges_of(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, EdgeUse> edges;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      ++(a < b ? edges[{a, b}].forward : edges[{b, a}].backward);
    }
  return edges;
}

// Brute force: what `remesh` relies on.
void expect_surface(const TriangleMesh& mesh, bool closed) {
  ASSERT_FALSE(mesh.triangles.empty());
  std::set<Index> used;
  for (const Triangle& t : mesh.triangles) {
    used.insert(t.begin(), t.end());
    EXPECT_FALSE(mesh::collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  EXPECT_EQ(used.size(), mesh.vertices.size());
  EXPECT_EQ(*used.rbegin(), static_cast<Index>(mesh.vertices.size()) - 1);
  for (const auto& [edge, use] : edges_of(mesh)) {
    if (use.forward + use.backward > 2) {  // patches meet here
      EXPECT_FALSE(closed);
      continue;
    }
    EXPECT_LE(use.forward, 1);
    EXPECT_LE(use.backward, 1);
    if (closed) {
      EXPECT_EQ(use.forward + use.backward, 2);
    }
  }
}

long euler_characteristic(const TriangleMesh& mesh) {
  return static_cast<long>(mesh.vertices.size()) - static_cast<long>(edges_of(mesh).size()) +
         static_cast<long>(mesh.triangles.size());
}

double signed_volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const Triangle& t : mesh.triangles)
    v += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  return v;
}

// The element named in the exception; -2 if there is none.
Index refused_at(const TriangleMesh& mesh) {
  try {
    clean(mesh);
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()), "");
    return error.element();
  }
  return -2;
}

TEST(Clean, LeavesAGoodMeshAlone) {
  const TriangleMesh mesh = torus();
  const CleanResult result = clean(mesh);
  EXPECT_TRUE(result.repairs.empty());
  EXPECT_EQ(result.mesh.vertices, mesh.vertices);
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
  // Cleaning twice is cleaning once.
  EXPECT_EQ(clean(result.mesh).mesh.triangles, mesh.triangles);
}

TEST(Clean, TurnsTheMinority) {
  TriangleMesh mesh = torus();
  const double volume = signed_volume(mesh);
  for (std::size_t t = 3; t < 40; t += 2) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const CleanResult result = clean(mesh);
  expect_surface(result.mesh, true);
  EXPECT_NEAR(signed_volume(result.mesh), volume, 1e-9);
  ASSERT_EQ(result.repairs.size(), 1u);
  EXPECT_EQ(result.repairs[0].count, 19);
  EXPECT_EQ(result.repairs[0].first, 3);
}

TEST(Clean, DropsDuplicatesRepeatsAndUnusedVertices) {
  TriangleMesh mesh = torus();
  const TriangleMesh good = mesh;
  const Triangle f = mesh.triangles[7];
  mesh.triangles.push_back({f[1], f[2], f[0]});
  mesh.triangles.insert(mesh.triangles.begin() + 2, {5, 5, 9});
  mesh.vertices.push_back({1, 2, 3});
  const CleanResult result = clean(mesh);
  EXPECT_EQ(result.mesh.vertices, good.vertices);
  EXPECT_EQ(result.mesh.triangles, good.triangles);
  EXPECT_EQ(result.repairs.size(), 3u);
  for (const Repair& r : result.repairs) EXPECT_EQ(r.count, 1) << r.what;
}

// A point on an edge, filled by a needle on one side only, as T-junctions are closed by modellers.
TriangleMesh with_needles(int count) {
  TriangleMesh mesh = torus();
  for (int i = 0; i < count; ++i) {
    Triangle& t = mesh.triangles[static_cast<std::size_t>(i) * 5];
    // Exact midpoints: the coordinates are made short first.
    for (Vec3& p : mesh.vertices) {
      const auto short_of = [](double x) { return std::round(x * 1024) / 1024; };
      p = {short_of(p.x), short_of(p.y), short_of(p.z)};
    }
    const Index c = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]]));
    const Triangle first{t[0], c, t[2]};
    const Triangle second{c, t[1], t[2]};
    const Triangle needle{t[0], t[1], c};
    t = first;
    mesh.triangles.push_back(second);
    mesh.triangles.push_back(needle);
  }
  return mesh;
}

TEST(Clean, NeedlesGoWithoutTearingTheSurface) {
  for (int count = 1; count <= 8; ++count) {
    const TriangleMesh mesh = with_needles(count);
    const CleanResult result = clean(mesh);
    expect_surface(result.mesh, true);
    EXPECT_EQ(euler_characteristic(result.mesh), 0);
    EXPECT_EQ(result.mesh.vertices, mesh.vertices);  // flips move nothing
    EXPECT_NEAR(signed_volume(result.mesh), signed_volume(mesh), 1e-9);
  }
}

TEST(Clean, CoincidentNeighboursAreMerged) {
  // Every vertex of a row moved onto the next row: quads between them have no area.
  TriangleMesh mesh = torus(8, 6);
  for (Index j = 0; j < 6; ++j) mesh.vertices[6 + j] = mesh.vertices[j];
  const CleanResult result = clean(mesh);
  expect_surface(result.mesh, true);
  EXPECT_EQ(euler_characteristic(result.mesh), 0);
  EXPECT_EQ(result.mesh.vertices.size(), mesh.vertices.size() - 6);
}

TEST(Clean, NeedlesAtTheBoundaryAreDropped) {
  const TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}}};
  const CleanResult result = clean(mesh);
  EXPECT_EQ(result.mesh.triangles.size(), 2u);
  expect_surface(result.mesh, false);
}

TEST(Clean, RefusesWhatCannotBeMended) {
  const TriangleMesh good = torus();
  TriangleMesh mesh = good;
  mesh.triangles.clear();
  EXPECT_EQ(refused_at(mesh), -1);
  EXPECT_EQ(refused_at({}), -1);

  mesh = good;
  mesh.vertices[11].y = std::nan("");
  EXPECT_EQ(refused_at(mesh), 11);
  mesh = good;
  mesh.vertices[12].z = -HUGE_VAL;
  EXPECT_EQ(refused_at(mesh), 12);
  mesh = good;
  mesh.triangles[17][1] = 48;
  EXPECT_EQ(refused_at(mesh), 17);
  mesh.triangles[17][1] = -1;
  EXPECT_EQ(refused_at(mesh), 17);

  // The same three vertices, opposite order.
  mesh = good;
  mesh.triangles.push_back({good.triangles[3][1], good.triangles[3][0], good.triangles[3][2]});
  EXPECT_EQ(refused_at(mesh), 96);

  // No area anywhere.
  mesh = good;
  for (Vec3& p : mesh.vertices) p = {p.x, p.x, p.x};
  EXPECT_EQ(refused_at(mesh), 0);
}

// Two tori that touch in vertex 5.
TriangleMesh touching_tori() {
  const TriangleMesh one = torus();
  TriangleMesh mesh = one;
  for (const Vec3& p : one.vertices) mesh.vertices.push_back(p + Vec3{20, 0, 0});
  for (const Triangle& t : one.triangles)
    mesh.triangles.push_back(
        {t[0] == 0 ? 5 : t[0] + 48, t[1] == 0 ? 5 : t[1] + 48, t[2] == 0 ? 5 : t[2] + 48});
  return mesh;
}

// A torus with a fin of two triangles on an edge.
TriangleMesh torus_with_fin() {
  TriangleMesh mesh = torus();
  const auto [a, b, c] = mesh.triangles[0];
  mesh.vertices.push_back(mesh.vertices[a] + Vec3{0, 0, 3});
  mesh.vertices.push_back(mesh.vertices[b] + Vec3{0, 0, 3});
  mesh.triangles.push_back({a, b, 48});
  mesh.triangles.push_back({b, 48, 49});  // the other way round
  return mesh;
}

TEST(Clean, KeepsCurvesAndPointsWherePatchesMeet) {
  const TriangleMesh fin = torus_with_fin();
  const CleanResult result = clean(fin);
  EXPECT_EQ(result.mesh.vertices, fin.vertices);
  EXPECT_EQ(result.mesh.triangles.size(), fin.triangles.size());
  ASSERT_EQ(result.repairs.size(), 1u);  // one face of the fin turned, none of the torus
  EXPECT_EQ(result.repairs[0].count, 1);
  ASSERT_EQ(result.kept.size(), 1u);
  EXPECT_EQ(result.kept[0].count, 1);
  EXPECT_EQ(result.kept[0].first, 0);
  EXPECT_TRUE(clean(result.mesh).repairs.empty());

  const CleanResult touching = clean(touching_tori());
  EXPECT_TRUE(touching.repairs.size() == 1 && touching.repairs[0].count == 1);  // vertex 48
  ASSERT_EQ(touching.kept.size(), 1u);
  EXPECT_EQ(touching.kept[0].count, 1);
  EXPECT_EQ(touching.kept[0].first, 5);
}

TEST(Clean, NeedlesGoWherePatchesMeetToo) {
  TriangleMesh mesh = torus_with_fin();
  // A needle between the two triangles of the fin: their common edge gets a point on one side.
  const auto n = static_cast<Index>(mesh.vertices.size());
  const Triangle last = mesh.triangles.back();
  mesh.vertices.push_back(0.5 * (mesh.vertices[last[0]] + mesh.vertices[last[1]]));
  mesh.triangles.back() = {last[0], n, last[2]};
  mesh.triangles.push_back({n, last[1], last[2]});
  mesh.triangles.push_back({last[0], last[1], n});
  const CleanResult result = clean(mesh);
  expect_surface(result.mesh, false);
  ASSERT_EQ(result.kept.size(), 1u);
  EXPECT_EQ(result.kept[0].count, 1);
}

TEST(Clean, RefusesAMoebiusStrip) {
  TriangleMesh mesh;
  constexpr Index n = 9;
  for (Index i = 0; i < n; ++i) {
    const double a = 6.283185307179586 * i / n;
    for (const double s : {-0.3, 0.3})
      mesh.vertices.push_back({(2 + s * std::cos(a / 2)) * std::cos(a),
                               (2 + s * std::cos(a / 2)) * std::sin(a), s * std::sin(a / 2)});
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i;
    const Index b = 2 * i + 1;
    const Index c = i + 1 < n ? a + 2 : 1;
    const Index d = i + 1 < n ? b + 2 : 0;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  EXPECT_GE(refused_at(mesh), 0);
}

TEST(Clean, ScaleDoesNotMatter) {
  for (const int exponent : {-900, -300, 0, 300, 1000}) {
    TriangleMesh mesh = with_needles(4);
    for (Vec3& p : mesh.vertices)
      p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    const CleanResult result = clean(mesh);
    EXPECT_EQ(result.mesh.triangles, clean(with_needles(4)).mesh.triangles) << exponent;
  }
}

bool collinear_in_rationals(const Vec3& a, const Vec3& b, const Vec3& c) {
  using boost::multiprecision::cpp_rational;
  const auto coordinates = [](const Vec3& p) {
    return std::array<cpp_rational, 3>{cpp_rational(p.x), cpp_rational(p.y), cpp_rational(p.z)};
  };
  const auto p = coordinates(a);
  const auto q = coordinates(b);
  const auto r = coordinates(c);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((q[i] - p[i]) * (r[j] - p[j]) != (q[j] - p[j]) * (r[i] - p[i])) return false;
  }
  return true;
}

TEST(Collinear, AgreesWithRationals) {
  numeric::Random random(7);
  int degenerate = 0;
  for (int i = 0; i < 3000; ++i) {
    // Points of a line with short coordinates, some moved by one unit in the last place.
    const auto grid = [&] { return static_cast<double>(random.below(64)) - 32; };
    const Vec3 a{grid() / 8, grid() / 8, grid() / 8};
    const Vec3 d{grid(), grid(), grid()};
    const Vec3 b = a + 0.125 * d;
    Vec3 c = a + grid() / 16 * d;
    if (random.below(2) == 0) c.x = std::nextafter(c.x, 100.0);
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(200)) - 100);
    const bool expected = collinear_in_rationals(scale * a, scale * b, scale * c);
    EXPECT_EQ(mesh::collinear(scale * a, scale * b, scale * c), expected);
    degenerate += expected ? 1 : 0;
  }
  EXPECT_GT(degenerate, 500);
  EXPECT_LT(degenerate, 2500);
}

TEST(BadFiles, GiveASurfaceOrASentence) {
  const std::string folder = NONOBTUSE_MODELS "/bad";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no models at " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    try {
      expect_surface(clean(read_mesh(entry.path().string()).mesh).mesh, false);
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(entry.path().filename().string()),
                std::string::npos);
    } catch (const InvalidInput& error) {
      EXPECT_GE(error.element(), 0);
    }
  }
}

TEST(BadFiles, ClosedSurfacesWithNeedlesStayClosed) {
  if (!std::filesystem::exists(NONOBTUSE_MODELS)) GTEST_SKIP() << "no models";
  for (const char* name : {"stl_zero_area_triangle.stl", "triceratops_cgal.off",
                           "syn_huge_1e300.off", "syn_spot_half_flipped.off"})
    expect_surface(clean(read_mesh(std::string(NONOBTUSE_MODELS "/bad/") + name).mesh).mesh, true);
  for (const char* name : {"moebius_gc.obj", "syn_klein_bottle.off"})
    EXPECT_THROW(clean(read_mesh(std::string(NONOBTUSE_MODELS "/bad/") + name).mesh), InvalidInput);
  for (const char* name : {"fan3.obj", "hourglass_ico.obj", "syn_two_cubes_share_edge.off"})
    EXPECT_EQ(clean(read_mesh(std::string(NONOBTUSE_MODELS "/bad/") + name).mesh).kept.size(), 1u);
}

}  // namespace
}  // namespace nonobtuse
