// What is written reads back the same, bit for bit; real files read as their manifest says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "nonobtuse/io.h"
#include "numeric/random.h"

namespace nonobtuse {
namespace {

namespace fs = std::filesystem;

// Vertices over all magnitudes a double has, faces at random but all of three distinct vertices;
// vertex v is first named by triangle order, so that even STL keeps the numbering.
TriangleMesh random_mesh(std::uint64_t seed, bool floats) {
  numeric::Random random(seed);
  TriangleMesh mesh;
  const auto coordinate = [&] {
    for (;;) {
      const std::uint64_t bits = random.next();
      double x = 0;
      std::memcpy(&x, &bits, sizeof x);
      if (floats) x = static_cast<double>(static_cast<float>(random.uniform() - 0.5));
      if (std::isfinite(x)) return x;
    }
  };
  const Index count = 3 + static_cast<Index>(random.below(50));
  for (Index v = 0; v < count; ++v)
    mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
  for (Index v = 2; v < count; ++v) mesh.triangles.push_back({v - 2, v - 1, v});
  for (Index t = 0; t < count; ++t) {
    const Index a = static_cast<Index>(random.below(count));
    mesh.triangles.push_back({a, (a + 1) % count, (a + 2) % count});
  }
  return mesh;
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  EXPECT_EQ(a.triangles, b.triangles);
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    EXPECT_EQ(std::memcmp(&a.vertices[v], &b.vertices[v], sizeof(Vec3)), 0)
        << "vertex " << v
        << fmt::format(": {} {} {} / {} {} {}", a.vertices[v].x, a.vertices[v].y, a.vertices[v].z,
                       b.vertices[v].x, b.vertices[v].y, b.vertices[v].z);
}

TEST(RoundTrip, EveryFormatKeepsEveryBit) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const TriangleMesh mesh = random_mesh(seed, false);
    for (const FileFormat format :
         {FileFormat::Obj, FileFormat::Off, FileFormat::Ply, FileFormat::Stl})
      for (const bool binary : {true, false}) {
        if (format == FileFormat::Stl && binary) continue;
        const ReadResult back =
            read_mesh_from_memory(write_mesh_to_memory(format, mesh, {.binary = binary}));
        EXPECT_EQ(back.format, format);
        expect_same(back.mesh, mesh);
      }
  }
}

TEST(RoundTrip, BinaryStlReadsAsWritten) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    TriangleMesh mesh = random_mesh(seed, true);
    for (Vec3& p : mesh.vertices) p.x *= 1 + 1e-12;  // no longer a float
    const TriangleMesh rounded = as_written("x.STL", mesh);
    expect_same(read_mesh_from_memory(write_mesh_to_memory(FileFormat::Stl, mesh)).mesh, rounded);
    expect_same(as_written("x.stl", mesh, {.binary = false}), mesh);
    expect_same(as_written("x.ply", mesh), mesh);
  }
}

TEST(RoundTrip, BinaryStlRefusesWhatFloatsCannotHold) {
  TriangleMesh mesh{{{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(write_mesh_to_memory(FileFormat::Stl, mesh), InvalidInput);
  EXPECT_NO_THROW(write_mesh_to_memory(FileFormat::Stl, mesh, {.binary = false}));
}

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("nonobtuse_io_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(Files, WritesReplaceAndLeaveNothingElse) {
  const TriangleMesh first = random_mesh(1, true);
  const TriangleMesh second = random_mesh(2, true);
  for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl"}) {
    write_mesh(path(name), first);
    write_mesh(path(name), second);
    expect_same(read_mesh(path(name)).mesh, second);
  }
  EXPECT_EQ(entries(), 4u);
}

TEST_F(Files, FailedWritesNameTheFileAndLeaveNothing) {
  const TriangleMesh mesh = random_mesh(1, true);
  for (const std::string& bad : {path("missing/a.obj"), path("a.xyz"), path("a"), path("")})
    EXPECT_THROW(write_mesh(bad, mesh), IoError) << bad;
  fs::create_directory(path("folder.obj"));
  EXPECT_THROW(write_mesh(path("folder.obj"), mesh), IoError);
  fs::remove(path("folder.obj"));
  TriangleMesh broken = mesh;
  broken.triangles[0][0] = 1000;
  EXPECT_THROW(write_mesh(path("a.obj"), broken), InvalidInput);
  EXPECT_EQ(entries(), 0u);
}

TEST_F(Files, LinksAreFollowed) {
  const TriangleMesh mesh = random_mesh(1, true);
  write_mesh(path("real.obj"), mesh);
  fs::create_symlink(path("real.obj"), path("link.obj"));
  const TriangleMesh other = random_mesh(2, true);
  write_mesh(path("link.obj"), other);
  EXPECT_TRUE(fs::is_symlink(path("link.obj")));
  expect_same(read_mesh(path("real.obj")).mesh, other);
}

TEST_F(Files, LinksToNothingYetAreFollowedAndLoopsRefused) {
  const TriangleMesh mesh = random_mesh(1, true);
  fs::create_symlink("real.obj", path("link.obj"));  // beside the link
  write_mesh(path("link.obj"), mesh);
  EXPECT_TRUE(fs::is_symlink(path("link.obj")));
  expect_same(read_mesh(path("real.obj")).mesh, mesh);
  fs::create_symlink("b.obj", path("a.obj"));
  fs::create_symlink("a.obj", path("b.obj"));
  EXPECT_THROW(write_mesh(path("a.obj"), mesh), IoError);
}

TEST_F(Files, PermissionsAreKept) {
  const TriangleMesh mesh = random_mesh(1, true);
  write_mesh(path("a.obj"), mesh);
  const fs::perms secret = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(path("a.obj"), secret);
  write_mesh(path("a.obj"), random_mesh(2, true));
  EXPECT_EQ(fs::status(path("a.obj")).permissions(), secret);
}

TEST_F(Files, AnyFileIsWrittenWholeBesideOthers) {
  write_file(path("a.html.part"), "precious");
  write_file(path("a.html"), "page");
  EXPECT_EQ(fs::file_size(path("a.html")), 4u);
  EXPECT_EQ(fs::file_size(path("a.html.part")), 8u);
  EXPECT_EQ(entries(), 2u);
}

TEST_F(Files, ContentWinsOverSuffix) {
  const TriangleMesh mesh = random_mesh(3, true);
  for (const FileFormat format :
       {FileFormat::Obj, FileFormat::Off, FileFormat::Ply, FileFormat::Stl})
    for (const bool binary : {true, false})
      for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl", "a.txt", "a"}) {
        // An OBJ may hold anything, so only its own suffix is believed without looking further.
        if (format == FileFormat::Stl && !binary && std::string(name) == "a.obj") continue;
        std::ofstream(path(name), std::ios::binary)
            << write_mesh_to_memory(format, mesh, {.binary = binary});
        const ReadResult back = read_mesh(path(name));
        EXPECT_EQ(back.format, format) << name;
        expect_same(back.mesh, mesh);
      }
}

struct Known {
  const char* file;
  std::size_t vertices;
  std::size_t triangles;
};

TEST(RealFiles, ReadAsTheirManifestSays) {
  const Known known[] = {{"paper/homer.obj", 6002, 12000},
                         {"paper/elk_10k.off", 5194, 10388},
                         {"cad/tm_plate_holes.stl", 618, 1252},
                         {"open/terrain_gmsh.stl", 1813, 3498},
                         {"bad/syn_big_endian_double.ply", 162, 320},
                         {"bad/syn_crlf.off", 162, 320},
                         {"bad/tm_negative_indices.obj", 8, 12},
                         {"bad/dodecahedron_poly.obj", 20, 36},
                         {"bad/tm_angle_block_cracked.stl", 398, 704},
                         {"bad/quads_to_stitch_cgal.off", 20, 16},
                         {"bad/syn_huge_1e300.off", 162, 320},
                         {"bad/triceratops_cgal.off", 2832, 5660}};
  if (!fs::exists(NONOBTUSE_MODELS)) GTEST_SKIP() << "no models at " NONOBTUSE_MODELS;
  for (const Known& k : known) {
    const ReadResult r = read_mesh(std::string(NONOBTUSE_MODELS "/") + k.file);
    EXPECT_EQ(r.mesh.vertices.size(), k.vertices) << k.file;
    EXPECT_EQ(r.mesh.triangles.size(), k.triangles) << k.file;
  }
}

}  // namespace
}  // namespace nonobtuse
