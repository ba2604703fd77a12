// What a remeshed surface takes over: linear fields, areas of labels, seams.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "nonobtuse/attributes.h"
#include "nonobtuse/error.h"
#include "nonobtuse/remesh.h"
#include "numeric/vec3.h"
#include "rdt/shapes.h"

namespace nonobtuse {
namespace {

double area_of(const TriangleMesh& m, const Triangle& t) {
  return 0.5 * length(area_vector(m.vertices[t[0]], m.vertices[t[1]], m.vertices[t[2]]));
}

std::map<Index, double> areas(const TriangleMesh& m, const std::vector<Index>& labels) {
  std::map<Index, double> sums;
  for (std::size_t t = 0; t < labels.size(); ++t) sums[labels[t]] += area_of(m, m.triangles[t]);
  return sums;
}

TEST(TransferAttributes, ReproducesALinearFieldOfColours) {
  const TriangleMesh torus = shapes::torus(40, 20);
  const auto color_at = [](const Vec3& p) {
    return Color{0.5 + 0.3 * p.x, 0.4 + 0.2 * p.y - 0.1 * p.z, 0.5, 0.5 - 0.25 * p.x};
  };
  MeshAttributes given;
  for (const Vec3& p : torus.vertices) given.colors.push_back(color_at(p));
  const RemeshResult result = remesh(torus, {.vertices = 300, .on_surface = true});
  const MeshAttributes out = transfer_attributes(torus, given, result);
  ASSERT_EQ(out.colors.size(), 300);
  for (std::size_t v = 0; v < out.colors.size(); ++v) {
    const Color expected = color_at(result.mesh.vertices[v]);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(out.colors[v][c], expected[c], 1e-6);
  }
  EXPECT_TRUE(out.labels.empty());
  EXPECT_TRUE(out.texture_triangles.empty());
}

TEST(TransferAttributes, LabelsKeepTheirAreas) {
  const TriangleMesh torus = shapes::torus(60, 30);
  MeshAttributes given;
  for (const Triangle& t : torus.triangles) {
    const Vec3 c = (torus.vertices[t[0]] + torus.vertices[t[1]] + torus.vertices[t[2]]) / 3;
    given.labels.push_back(c.x > 0 ? 4 : c.y > 0 ? 7 : 1);
  }
  given.label_names = {"", "south-west"};
  const RemeshResult result = remesh(torus, {.vertices = 1200});
  const MeshAttributes out = transfer_attributes(torus, given, result);
  EXPECT_EQ(out.label_names, given.label_names);
  const auto before = areas(torus, given.labels);
  const auto after = areas(result.mesh, out.labels);
  ASSERT_EQ(after.size(), 3);
  for (const auto& [label, area] : before) EXPECT_NEAR(after.at(label), area, 0.02 * area);
}

// A thin plate, above labelled 1 and below 2: nearest points must not reach through it.
TEST(TransferAttributes, TellsTheSidesOfAThinSheetApart) {
  TriangleMesh plate = shapes::box(12, 12, 1);
  for (Vec3& p : plate.vertices) p.z *= 0.02;
  MeshAttributes given;
  for (const Triangle& t : plate.triangles)
    given.labels.push_back(
        area_vector(plate.vertices[t[0]], plate.vertices[t[1]], plate.vertices[t[2]]).z > 0 ? 1
                                                                                            : 2);
  const RemeshResult result = remesh(plate, {.vertices = 600, .method = Method::Cvt});
  const MeshAttributes out = transfer_attributes(plate, given, result);
  for (std::size_t t = 0; t < out.labels.size(); ++t) {
    const Triangle& f = result.mesh.triangles[t];
    const Vec3 a = area_vector(result.mesh.vertices[f[0]], result.mesh.vertices[f[1]],
                               result.mesh.vertices[f[2]]);
    if (std::abs(a.z) > 0.9 * length(a)) {
      EXPECT_EQ(out.labels[t], a.z > 0 ? 1 : 2);
    }
  }
}

// A torus unwrapped to a square, angle over angle: two seams. The texture of a face is as large as
// its angles are, so that no face spans the whole square; inside, faces share their coordinates.
struct Unwrapped {
  TriangleMesh mesh = shapes::torus(48, 24);
  MeshAttributes attributes;
  Unwrapped() {
    const int rows = 48;
    const int columns = 24;
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; j <= columns; ++j)
        attributes.texture_coordinates.push_back(
            {static_cast<double>(i) / rows, static_cast<double>(j) / columns});
    const auto at = [&](int i, int j) { return i * (columns + 1) + j; };
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        attributes.texture_triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        attributes.texture_triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
};

TEST(AttributeBorders, AreTheSeamsAndTheEdgesBetweenLabels) {
  Unwrapped torus;
  EXPECT_EQ(attribute_borders(torus.mesh, torus.attributes).size(), 48 + 24);
  MeshAttributes labels;
  labels.labels.assign(torus.mesh.triangles.size(), 0);
  EXPECT_TRUE(attribute_borders(torus.mesh, labels).empty());
  labels.labels[100] = 1;
  const auto borders = attribute_borders(torus.mesh, labels);
  ASSERT_EQ(borders.size(), 3);
  for (const auto& [a, b] : borders) {
    EXPECT_LT(a, b);
    for (const Index v : {a, b})
      EXPECT_TRUE(
          std::count(torus.mesh.triangles[100].begin(), torus.mesh.triangles[100].end(), v));
  }
  EXPECT_TRUE(std::is_sorted(borders.begin(), borders.end()));
  EXPECT_TRUE(attribute_borders(torus.mesh, {}).empty());
}

TEST(TransferAttributes, SeamsStaySeams) {
  const Unwrapped torus;
  const RemeshResult result = remesh(torus.mesh, {.vertices = 800});
  const MeshAttributes out = transfer_attributes(torus.mesh, torus.attributes, result);
  ASSERT_EQ(out.texture_triangles.size(), result.mesh.triangles.size());
  double area = 0;
  for (const Triangle& t : out.texture_triangles) {
    const auto& a = out.texture_coordinates[t[0]];
    const auto& b = out.texture_coordinates[t[1]];
    const auto& c = out.texture_coordinates[t[2]];
    for (int k = 0; k < 2; ++k) {
      const auto [low, high] = std::minmax({a[k], b[k], c[k]});
      EXPECT_LT(high - low, 0.25);  // none reaches over a seam
    }
    area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  }
  EXPECT_NEAR(area, 1, 0.06);  // the whole square; faces on a seam lose what lies beyond it
  // A vertex has one texture coordinate, but for the few that faces on a seam's two sides share.
  std::vector<std::set<Index>> at_vertex(result.mesh.vertices.size());
  for (std::size_t t = 0; t < out.texture_triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      at_vertex[result.mesh.triangles[t][k]].insert(out.texture_triangles[t][k]);
  const auto several =
      std::count_if(at_vertex.begin(), at_vertex.end(), [](const auto& s) { return s.size() > 1; });
  EXPECT_GT(several, 0);
  EXPECT_LT(several, 250);
  RemeshResult remeshed = result;
  EXPECT_FALSE(attribute_borders(result.mesh, out).empty());
  remeshed.source_triangle.clear();
  EXPECT_THROW(transfer_attributes(torus.mesh, torus.attributes, remeshed), InvalidInput);
}

// As features, borders of labels stay edges and areas stay what they are: exactly on a plane.
TEST(TransferAttributes, BordersKeptAsFeaturesKeepTheAreasOfLabels) {
  const TriangleMesh square = shapes::square(12);
  MeshAttributes given;
  for (const Triangle& t : square.triangles) {
    const Vec3 c = (square.vertices[t[0]] + square.vertices[t[1]] + square.vertices[t[2]]) / 3;
    given.labels.push_back(c.x < 0.5 ? 0 : c.y < 0.25 ? 1 : 2);
  }
  RemeshOptions options{.vertices = 300};
  options.feature_edges = attribute_borders(square, given);
  const RemeshResult result = remesh(square, options);
  const MeshAttributes out = transfer_attributes(square, given, result);
  const auto after = areas(result.mesh, out.labels);
  for (const auto& [label, area] : areas(square, given.labels))
    EXPECT_NEAR(after.at(label), area, 1e-6);
}

// Remeshed by itself, a mesh keeps everything: the seams lie on its edges.
TEST(TransferAttributes, TheSameMeshKeepsEverything) {
  const Unwrapped torus;
  RemeshResult same;
  same.mesh = torus.mesh;
  same.source_triangle.assign(torus.mesh.vertices.size(), -1);
  same.barycentric.resize(torus.mesh.vertices.size());
  for (std::size_t t = 0; t < torus.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Index v = torus.mesh.triangles[t][k];
      same.source_triangle[v] = static_cast<Index>(t);
      same.barycentric[v] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    }
  const MeshAttributes out = transfer_attributes(torus.mesh, torus.attributes, same);
  for (std::size_t t = 0; t < torus.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 2; ++c)
        EXPECT_NEAR(
            out.texture_coordinates[out.texture_triangles[t][k]][c],
            torus.attributes.texture_coordinates[torus.attributes.texture_triangles[t][k]][c],
            1e-12);
  EXPECT_EQ(attribute_borders(torus.mesh, out), attribute_borders(torus.mesh, torus.attributes));
  EXPECT_EQ(out.texture_coordinates.size(), torus.attributes.texture_coordinates.size());
}

}  // namespace
}  // namespace nonobtuse
