// What the four formats allow is read, what they do not is refused with its place; no bytes at all
// crash a reader.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "nonobtuse/io.h"
#include "numeric/random.h"

namespace nonobtuse {
namespace {

struct Accepted {
  const char* name;
  std::string bytes;
  std::size_t vertices;
  std::vector<Triangle> triangles;
};

void PrintTo(const Accepted& a, std::ostream* out) { *out << a.name; }

class Reads : public ::testing::TestWithParam<Accepted> {};

TEST_P(Reads, AsMeant) {
  const Accepted& a = GetParam();
  const ReadResult r = read_mesh_from_memory(a.bytes, a.name);
  EXPECT_EQ(r.mesh.vertices.size(), a.vertices);
  std::vector<Triangle> triangles = r.mesh.triangles;
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  EXPECT_EQ(triangles, a.triangles);
  EXPECT_EQ(r.mesh.vertices[1], (Vec3{1, 0, 0}));
}

const std::string obj_corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string off_corners = "0 0 0\n1 0 0\n0 1 0\n";
const std::vector<Triangle> one{{0, 1, 2}};

INSTANTIATE_TEST_SUITE_P(
    Obj, Reads,
    ::testing::Values(
        Accepted{"plain.obj", obj_corners + "f 1 2 3\n", 3, one},
        Accepted{"no_last_line_end.obj", obj_corners + "f 1 2 3", 3, one},
        Accepted{"returns.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", 3, one},
        Accepted{"old_mac.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", 3, one},
        Accepted{"slashes.obj", obj_corners + "f 1/1 2//7 3/4/5\n", 3, one},
        Accepted{"negative.obj", obj_corners + "f -3 -2 -1\nv 5 5 5\n", 4, one},
        Accepted{"faces_first.obj", "f 1 2 3\n" + obj_corners, 3, one},
        Accepted{"continued.obj", obj_corners + "f 1 \\\n2\\\r\n 3\n", 3, one},
        Accepted{"all_else.obj",
                 "# c\nmtllib a\no x\ng y z\ns off\nvt 0 0\nvn 0 0 1\nusemtl m\nl 1 2\n" +
                     obj_corners + "f 1 2 3 # end\n",
                 3, one},
        Accepted{"colours.obj", "v +0 -0.0 0 1 1 1\n\tv 1e0 0 0 .5\nv 0 1. 0\nf 1 2 3\n", 3, one},
        Accepted{"mark.obj", "\xEF\xBB\xBF" + obj_corners + "f 1 2 3\n", 3, one},
        Accepted{"two_corners.obj", obj_corners + "f 1 2\nf 1 2 3\n", 3, one}));

INSTANTIATE_TEST_SUITE_P(
    Off, Reads,
    ::testing::Values(
        Accepted{"plain.off", "OFF\n3 1 0\n" + off_corners + "3 0 1 2\n", 3, one},
        Accepted{"one_line.off", "OFF 3 1 0\n" + off_corners + "3 0 1 2", 3, one},
        Accepted{"no_edges.off", "OFF\n3 1\n" + off_corners + "3 0 1 2\n", 3, one},
        Accepted{"returns.off", "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", 3, one},
        Accepted{"comments.off",
                 "# a\n\nOFF # b\n#c\n3 1 0 # d\n0 0 0 #e\n\n1 0 0\n#f\n0 1 0\n3 0 1 2 #g", 3, one},
        Accepted{"face_colours.off", "OFF\n3 1 0\n" + off_corners + "3 0 1 2 255 0 0 1\n", 3, one},
        Accepted{"colours.off", "COFF\n3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 0 0 0 1\n3 0 1 2",
                 3, one},
        Accepted{"normals.off", "CNOFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 0 0 0 1\n3 0 1 2",
                 3, one},
        Accepted{"quad.off",
                 "OFF 4 1 0\n0 0 0\n1 0 0\n2 1 0\n0 1 0\n4 0 1 2 3",
                 4,
                 {{0, 1, 3}, {1, 2, 3}}}));

const std::string ply_start = "ply\nformat ascii 1.0\ncomment x\nobj_info y\n";
const std::string ply_xyz = "property float x\nproperty double y\nproperty int z\n";

INSTANTIATE_TEST_SUITE_P(
    Ply, Reads,
    ::testing::Values(
        Accepted{"plain.ply",
                 ply_start + "element vertex 3\n" + ply_xyz +
                     "element face 1\nproperty list uchar int vertex_index\nend_header\n" +
                     off_corners + "3 0 1 2\n",
                 3, one},
        Accepted{"extras.ply",
                 ply_start +
                     "element camera 1\nproperty list int float c\nproperty uchar d\n"
                     "element vertex 3\nproperty uchar red\n" +
                     ply_xyz +
                     "element face 1\nproperty list uchar float uv\n"
                     "property list ushort uint vertex_indices\nproperty float q\n"
                     "element edge 1\nproperty int a\nend_header\n2 1.5 2.5 7\n" +
                     "9 0 0 0\n9 1 0 0\n9 0 1 0\n1 0.5 3 0 1 2 8\n4\n",
                 3, one},
        Accepted{"faces_first.ply",
                 ply_start +
                     "element face 1\nproperty list uchar int vertex_index\nelement vertex 3\n" +
                     ply_xyz + "end_header\n3 0 1 2\n" + off_corners,
                 3, one},
        Accepted{"returns.ply",
                 "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\n"
                 "property float y\r\nproperty float z\r\nelement face 1\r\n"
                 "property list uchar int vertex_indices\r\nend_header\r\n0 0 0\r\n1 0 0\r\n"
                 "0 1 0\r\n3 0 1 2\r\n",
                 3, one}));

const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

INSTANTIATE_TEST_SUITE_P(
    Stl, Reads,
    ::testing::Values(
        Accepted{"plain.stl", "solid a b\n" + facet + "endsolid a b\n", 3, one},
        Accepted{"capitals.stl",
                 "SOLID\n FACET NORMAL nan nan nan\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 "
                 "0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n",
                 3, one},
        Accepted{"several.stl",
                 "solid\n" + facet + "endsolid\nsolid b\n" + facet + "endsolid b",
                 3,
                 {{0, 1, 2}, {0, 1, 2}}},
        Accepted{"zeros.stl",
                 "solid\n" + facet +
                     "facet normal 0 0 0\nouter loop\nvertex -0.0 1 -0\nvertex 1 0 0\nvertex 5 5 "
                     "5\nendloop\nendfacet\nendsolid",
                 4,
                 {{0, 1, 2}, {1, 3, 2}}}));

struct Refused {
  const char* name;
  std::string bytes;
  const char* says;  // a part of the sentence that tells where or what
};

void PrintTo(const Refused& r, std::ostream* out) { *out << r.name; }

class Refuses : public ::testing::TestWithParam<Refused> {};

TEST_P(Refuses, WithAPlace) {
  const Refused& r = GetParam();
  std::string sentence;
  try {
    read_mesh_from_memory(r.bytes, r.name);
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  EXPECT_NE(sentence.find(r.name), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(r.says), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
}

const std::string binary_ply =
    "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

INSTANTIATE_TEST_SUITE_P(
    All, Refuses,
    ::testing::Values(
        Refused{"e.obj", "", "empty"}, Refused{"e", " \n \n", "empty"},
        Refused{"garbage", "hello world", "not an OBJ"},
        Refused{"text.obj", "hello world", "no faces"},
        Refused{"points.obj", obj_corners, "no faces"},
        Refused{"a.obj", obj_corners + "f 1 2 4\n", "line 4"},
        Refused{"b.obj", obj_corners + "f 1 2 0\n", "line 4"},
        Refused{"c.obj", obj_corners + "f 1 2 -4\n", "line 4"},
        Refused{"d.obj", "v 0 0 0\nv 1 x 0\n", "line 2"},
        Refused{"f.obj", "v 0 0 0\nv 1 0\nf 1 1 1\n", "line 2"},
        Refused{"g.obj", "v 0 0 0\nv nan 0 0\n", "not finite"},
        Refused{"h.obj", "v 0 0 0\nv 1e999 0 0\n", "not finite"},
        Refused{"i.obj", obj_corners + "f 1 2 3x\n", "line 4"},
        Refused{"j.obj", obj_corners + "f 1 2 99999999999999999999999\n", "line 4"},
        Refused{"a.off", "OFF\n3 1 0\n" + off_corners, "truncated"},
        Refused{"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "truncated"},
        Refused{"c.off", "3 1 0\n" + off_corners + "3 0 1 2\n", "OFF"},
        Refused{"d.off", "OFF\n2000000000 2000000000 0\n0 0 0\n", "truncated"},
        Refused{"e.off", "OFF\n-3 1 0\n", "line 2"},
        Refused{"f.off", "OFF\n3 1 0\n" + off_corners + "3 0 1 3\n", "line 6"},
        Refused{"g.off", "OFF\n3 1 0\n" + off_corners + "2000000000 0 1 2\n", "line 6"},
        Refused{"h.off", "OFF\n3 1 0\n" + off_corners + "3 0 1\n3\n", "line 6"},
        Refused{"i.off", "OFF BINARY\n3 1 0\n", "binary"},
        Refused{"j.off", "4OFF\n3 1 0\n", "three coordinates"},
        Refused{"k.off", "OFF\n99999999999999999999 1 0\n", "line 2"},
        Refused{"a.ply", "ply\n", "truncated"},
        Refused{"b.ply", "ply\nformat ascii 1.0\nend_header\n", "vertices"},
        Refused{"c.ply", "ply\nelement vertex 3\nend_header\n", "format"},
        Refused{"d.ply", ply_start + "element vertex 3\nproperty float x\nend_header\n", "x, y"},
        Refused{"e.ply", ply_start + "element vertex 3\nproperty complex x\n", "line 6"},
        Refused{"f.ply", ply_start + "element vertex 999999999999\n" + ply_xyz + "end_header\n0",
                "truncated"},
        Refused{"g.ply", binary_ply + std::string(24, '\0'), "byte"},
        Refused{"h.ply", binary_ply + std::string(24, '\0') + std::string("\xff\0\0\0\0", 5),
                "byte"},
        Refused{"i.ply",
                binary_ply + std::string(24, '\0') + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13),
                "vertex 2"},
        Refused{"j.ply", "not a ply", "ply"}, Refused{"a.stl", "not an stl", "too few"},
        Refused{"b.stl", "solid\n" + facet, "endsolid"},
        Refused{"c.stl", "solid\nendsolid\n", "no facets"},
        Refused{"d.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\n",
                "line 6"},
        Refused{"e.stl", "solid\nwhat\n", "line 2"},
        Refused{"f.stl", std::string(80, 'x') + std::string("\xff\xff\xff\xff", 4), "byte 80"}));

TEST(MissingFiles, AreNamed) {
  for (const std::string& path : {std::string("/nowhere/at/all.obj"), std::string("")})
    EXPECT_THROW(read_mesh(path), IoError);
  EXPECT_THROW(read_mesh(std::filesystem::temp_directory_path().string()), IoError);
}

// Concave polygons keep their area: no triangle turned over, none outside.
TEST(Polygons, AreCoveredOnce) {
  const std::vector<std::vector<Vec3>> shapes{
      {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}},  // dart
      {{1, 1, 0}, {0, 4, 0}, {0, 0, 0}, {4, 0, 0}},  // rotated
      {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},
      {{0, 0, 0}, {2, 0, 2}, {2, 2, 2}, {1, 0.5, 1}, {0, 2, 0}}};  // tilted
  for (const auto& shape : shapes) {
    std::string bytes;
    for (const Vec3& p : shape) bytes += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    bytes += "f";
    for (std::size_t i = 1; i <= shape.size(); ++i) bytes += fmt::format(" {}", i);
    const ReadResult r = read_mesh_from_memory(bytes, "polygon.obj");
    ASSERT_EQ(r.mesh.triangles.size(), shape.size() - 2);
    ASSERT_EQ(r.repairs.size(), 1u);
    double twice = 0;  // in the plane z = 0
    double shoelace = 0;
    for (const Triangle& t : r.mesh.triangles) {
      const Vec3& a = r.mesh.vertices[t[0]];
      const Vec3& b = r.mesh.vertices[t[1]];
      const Vec3& c = r.mesh.vertices[t[2]];
      const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      EXPECT_GT(area, 0);
      twice += area;
    }
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const Vec3& p = shape[i];
      const Vec3& q = shape[(i + 1) % shape.size()];
      shoelace += p.x * q.y - q.x * p.y;
    }
    EXPECT_NEAR(twice, shoelace, 1e-12);
  }
}

// Welding knows places, not positions in the file: permuted facets give the same surface.
TEST(Welding, DoesNotDependOnTheOrderOfFacets) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  numeric::Random random(3);
  for (int round = 0; round < 50; ++round) {
    TriangleMesh permuted = mesh;
    for (std::size_t i = 3; i > 0; --i)
      std::swap(permuted.triangles[i], permuted.triangles[random.below(i + 1)]);
    const TriangleMesh back =
        read_mesh_from_memory(write_mesh_to_memory(FileFormat::Stl, permuted), "a.stl").mesh;
    ASSERT_EQ(back.vertices.size(), 4u);
    Index seen = 0;  // numbered by first appearance
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(back.vertices[back.triangles[t][k]], mesh.vertices[permuted.triangles[t][k]]);
        EXPECT_LE(back.triangles[t][k], seen);
        seen = std::max(seen, back.triangles[t][k] + 1);
      }
  }
}

TEST(DamagedFiles, NeverCrash) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0.25, 1e-3}, {0.5, 0, 0}},
                          {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 1, 4}}};
  std::vector<std::string> files;
  for (const FileFormat format :
       {FileFormat::Obj, FileFormat::Off, FileFormat::Ply, FileFormat::Stl})
    for (const bool binary : {true, false})
      files.push_back(write_mesh_to_memory(format, mesh, {.binary = binary}));
  files.push_back(obj_corners + "v 1 1 0\nv 2 3 4\nf 1 2 4 3\nf -1 -2 -3 -4 -5\n");
  numeric::Random random(1);
  const char* const names[] = {"a.obj", "a.off", "a.ply", "a.stl", "a"};
  int survived = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = files[random.below(files.size())];
    const std::uint64_t edits = 1 + random.below(4);
    for (std::uint64_t e = 0; e < edits && !bytes.empty(); ++e) {
      const std::size_t at = random.below(bytes.size());
      switch (random.below(4)) {
        case 0:
          bytes.resize(at);
          break;
        case 1:
          bytes[at] = static_cast<char>(random.below(256));
          break;
        case 2:
          bytes[at] = "0123456789-. \n"[random.below(14)];
          break;
        default:
          bytes.insert(at, bytes.substr(random.below(bytes.size()), random.below(40)));
      }
    }
    try {
      const ReadResult r = read_mesh_from_memory(bytes, names[random.below(5)]);
      for (const Triangle& t : r.mesh.triangles)
        for (const Index v : t)
          ASSERT_TRUE(v >= 0 && v < static_cast<Index>(r.mesh.vertices.size()));
      clean(r.mesh);
      ++survived;
    } catch (const IoError&) {
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(survived, 100);
}

}  // namespace
}  // namespace nonobtuse
