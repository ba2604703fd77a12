// Colours, textures and labels through OBJ and PLY, in and out, and through cleaning.
#include <gtest/gtest.h>

#include <string>

#include "nonobtuse/io.h"

namespace nonobtuse {
namespace {

// A square of two triangles, a seam along its diagonal.
TriangleMesh square() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

MeshAttributes full() {
  MeshAttributes a;
  a.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {0.2, 0.4, 0.6, 1}};
  a.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0.25, 0.5}, {0.75, 0.5}, {0, 1}};
  a.texture_triangles = {{0, 1, 2}, {3, 4, 5}};
  a.labels = {1, 0};
  a.label_names = {"red brick", "glass"};
  a.material_library = "house.mtl";
  return a;
}

void expect_same_texture(const MeshAttributes& a, const MeshAttributes& b, double tolerance) {
  ASSERT_EQ(a.texture_triangles.size(), b.texture_triangles.size());
  for (std::size_t t = 0; t < a.texture_triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 2; ++c)
        EXPECT_NEAR(a.texture_coordinates[a.texture_triangles[t][k]][c],
                    b.texture_coordinates[b.texture_triangles[t][k]][c], tolerance);
}

TEST(Attributes, ObjKeepsThemAll) {
  const MeshAttributes given = full();
  const ReadResult back =
      read_mesh_from_memory(write_mesh_to_memory(FileFormat::Obj, square(), given), "a.obj");
  EXPECT_EQ(back.mesh.triangles, square().triangles);
  EXPECT_EQ(back.attributes.colors, given.colors);
  expect_same_texture(back.attributes, given, 0);
  ASSERT_EQ(back.attributes.labels.size(), 2);
  for (int t = 0; t < 2; ++t)
    EXPECT_EQ(back.attributes.label_names[back.attributes.labels[t]],
              given.label_names[given.labels[t]]);
  EXPECT_EQ(back.attributes.material_library, "house.mtl");
  EXPECT_FALSE(back.attributes.labels_are_groups);
}

TEST(Attributes, PlyKeepsColoursTextureAndLabels) {
  for (const bool binary : {true, false})
    for (const double alpha : {1.0, 0.2}) {
      MeshAttributes given = full();
      given.colors[0][3] = alpha;
      const ReadResult back = read_mesh_from_memory(
          write_mesh_to_memory(FileFormat::Ply, square(), given, {.binary = binary}), "a.ply");
      EXPECT_EQ(back.attributes.colors, given.colors);  // multiples of 1 / 255
      expect_same_texture(back.attributes, given, 1e-7);
      EXPECT_EQ(back.attributes.labels, given.labels);
    }
}

TEST(Attributes, NoneMakeNoDifferenceToAFile) {
  for (const FileFormat format :
       {FileFormat::Obj, FileFormat::Off, FileFormat::Ply, FileFormat::Stl})
    EXPECT_EQ(write_mesh_to_memory(format, square(), MeshAttributes{}),
              write_mesh_to_memory(format, square()));
  EXPECT_EQ(write_mesh_to_memory(FileFormat::Off, square(), full()),
            write_mesh_to_memory(FileFormat::Off, square()));
}

TEST(Attributes, PolygonsShareThemOut) {
  const ReadResult read = read_mesh_from_memory(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
      "f 1 2 3\nusemtl b\nf 1/1 2/2 3/3 4/4\nusemtl c\nf 2 5 3\n",
      "a.obj");
  ASSERT_EQ(read.mesh.triangles.size(), 4);
  EXPECT_EQ(read.attributes.labels, (std::vector<Index>{0, 1, 1, 2}));
  EXPECT_EQ(read.attributes.label_names, (std::vector<std::string>{"", "b", "c"}));
  ASSERT_EQ(read.attributes.texture_triangles.size(), 4);
  EXPECT_EQ(read.attributes.texture_triangles[0], (Triangle{-1, -1, -1}));
  for (int t = 1; t < 3; ++t)  // here texture coordinates count as vertices do
    EXPECT_EQ(read.attributes.texture_triangles[t], read.mesh.triangles[t]);
  EXPECT_EQ(read.attributes.texture_triangles[3], (Triangle{-1, -1, -1}));
}

TEST(Attributes, GroupsAreLabelsWhereThereAreNoMaterials) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const ReadResult groups =
      read_mesh_from_memory(vertices + "g one\nf 1 2 3\ng two\nf 1 3 4\n", "a.obj");
  EXPECT_EQ(groups.attributes.label_names, (std::vector<std::string>{"one", "two"}));
  EXPECT_TRUE(groups.attributes.labels_are_groups);
  const std::string again = write_mesh_to_memory(FileFormat::Obj, groups.mesh, groups.attributes);
  EXPECT_NE(again.find("\ng two\nf 1 3 4\n"), std::string::npos) << again;
  const ReadResult both =
      read_mesh_from_memory(vertices + "g one\nusemtl m\nf 1 2 3\ng two\nf 1 3 4\n", "a.obj");
  EXPECT_EQ(both.attributes.labels, (std::vector<Index>{0, 0}));
  EXPECT_EQ(both.attributes.label_names, (std::vector<std::string>{"m"}));
}

// Whatever is wrong with an attribute, the mesh is read.
TEST(Attributes, BrokenOnesAreLeftOut) {
  const ReadResult read = read_mesh_from_memory(
      "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 0.5\nv 0 1 0 a b c\nvt x\n"
      "f 1/9 2/1 3/1\nf 1/-7 3/ 4/1\n",
      "a.obj");
  EXPECT_EQ(read.mesh.triangles.size(), 2);
  EXPECT_TRUE(read.attributes.colors.empty());
  for (const Triangle& t : read.attributes.texture_triangles) EXPECT_EQ(t, (Triangle{-1, -1, -1}));
}

TEST(Attributes, PlyOfOthers) {
  const ReadResult read = read_mesh_from_memory(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty float s\nproperty float t\nproperty ushort red\n"
      "property ushort green\nproperty ushort blue\nelement face 1\n"
      "property int material_index\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 65535 0 0\n1 0 0 1 0 0 65535 0\n1 1 0 1 1 0 0 65535\n0 1 0 0 1 0 0 0\n"
      "7 4 0 1 2 3\n",
      "a.ply");
  EXPECT_EQ(read.attributes.labels, (std::vector<Index>{7, 7}));
  EXPECT_EQ(read.attributes.colors[1], (Color{0, 1, 0, 1}));
  EXPECT_EQ(read.attributes.texture_triangles, read.mesh.triangles);
  EXPECT_EQ(read.attributes.texture_coordinates[2], (TextureCoordinate{1, 1}));
}

TEST(Attributes, ThatDoNotBelongToTheMeshAreRefused) {
  MeshAttributes wrong = full();
  wrong.colors.pop_back();
  EXPECT_THROW(write_mesh_to_memory(FileFormat::Obj, square(), wrong), InvalidInput);
  EXPECT_THROW(clean(square(), wrong), InvalidInput);
  wrong = full();
  wrong.texture_triangles[1][0] = 6;
  EXPECT_THROW(write_mesh_to_memory(FileFormat::Obj, square(), wrong), InvalidInput);
  wrong = full();
  wrong.labels[0] = -1;
  EXPECT_THROW(attribute_borders(square(), wrong), InvalidInput);
}

// Unused vertices, turned and degenerate faces: what is left keeps its own.
TEST(Attributes, FollowTheCleaning) {
  TriangleMesh mesh = square();
  mesh.vertices.insert(mesh.vertices.begin(), {9, 9, 9});
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) ++v;
  mesh.triangles.insert(mesh.triangles.begin(), {1, 1, 2});
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);  // turned over
  MeshAttributes given = full();
  given.colors.insert(given.colors.begin(), {0, 0, 0, 1});
  given.texture_triangles = {{0, 0, 0}, {0, 1, 2}, {4, 3, 5}};
  given.labels = {5, 1, 0};
  const CleanResult cleaned = clean(mesh, given);
  ASSERT_EQ(cleaned.mesh.vertices, square().vertices);
  EXPECT_EQ(cleaned.attributes.colors, full().colors);
  ASSERT_EQ(cleaned.mesh.triangles.size(), 2);
  EXPECT_EQ(cleaned.attributes.labels, (std::vector<Index>{1, 0}));
  EXPECT_EQ(cleaned.source_vertex, (std::vector<Index>{1, 2, 3, 4}));
  // Vertices 0, 2, 3 of the second face have the texture coordinates 3, 4, 5.
  for (int k = 0; k < 3; ++k) {
    const Index v = cleaned.mesh.triangles[1][k];
    EXPECT_EQ(cleaned.attributes.texture_triangles[1][k], v == 0 ? 3 : v == 2 ? 4 : 5);
  }
}

// A needle on the diagonal goes by a flip or a collapse; the faces beside it keep their labels.
TEST(Attributes, SurviveFacesWithoutArea) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                    {{0, 1, 4}, {1, 2, 4}, {0, 4, 2}, {0, 2, 3}}};
  MeshAttributes given;
  given.labels = {1, 2, 7, 3};
  const CleanResult cleaned = clean(mesh, given);
  ASSERT_EQ(cleaned.attributes.labels.size(), cleaned.mesh.triangles.size());
  for (std::size_t t = 0; t < cleaned.mesh.triangles.size(); ++t) {
    double x = 0;
    double y = 0;
    for (const Index v : cleaned.mesh.triangles[t]) {
      x += cleaned.mesh.vertices[v].x / 3;
      y += cleaned.mesh.vertices[v].y / 3;
    }
    if (x > y) {
      EXPECT_EQ(cleaned.attributes.labels[t], 1 + (x + y > 1 ? 1 : 0));
    } else {
      EXPECT_EQ(cleaned.attributes.labels[t], 3);
    }
  }
}

}  // namespace
}  // namespace nonobtuse
