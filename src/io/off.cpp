// Geomview's Object File Format: "[ST][C][N]OFF", the counts of vertices, faces and edges, then a
// line per vertex and per face; what follows the coordinates or indices on a line is skipped.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <iterator>
#include <limits>

#include "io/formats.h"
#include "io/mesh_builder.h"

namespace nonobtuse::io {

namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source) : scanner_(source), builder_(source) {}

  ReadResult read() {
    header();
    content("the counts of vertices and faces");
    const std::int64_t vertices = count("the number of vertices");
    const std::int64_t faces = count("the number of faces");
    scanner_.next_line();
    // A vertex takes at least six bytes, a face at least two.
    const std::size_t size = scanner_.remaining();
    if (vertices > static_cast<std::int64_t>(size / 6 + 1) ||
        faces > static_cast<std::int64_t>(size / 2 + 1))
      scanner_.fail(
          fmt::format("{} vertices and {} faces are announced, more than fit in the "
                      "{} bytes that follow: the file is truncated",
                      vertices, faces, size));
    builder_.reserve(static_cast<std::size_t>(vertices), static_cast<std::size_t>(faces));
    for (std::int64_t v = 0; v < vertices; ++v) vertex(v, vertices);
    for (std::int64_t f = 0; f < faces; ++f) face(f, faces);
    return builder_.finish(FileFormat::Off);
  }

 private:
  void header() {
    content("the word OFF");
    std::string_view word = scanner_.word();
    const bool is_off = word.size() >= 3 && word.substr(word.size() - 3) == "OFF";
    const std::string_view prefix = is_off ? word.substr(0, word.size() - 3) : "";
    if (!is_off || prefix.find_first_not_of("STCN4n") != std::string_view::npos)
      scanner_.fail("the file does not begin with the word OFF");
    if (prefix.find_first_of("4n") != std::string_view::npos)
      scanner_.fail("only OFF files with three coordinates per vertex can be read");
    scanner_.skip_blanks();
    const char* const rest = scanner_.position();
    if (scanner_.word() == "BINARY") scanner_.fail("binary OFF files cannot be read");
    scanner_.set_position(rest);
  }

  void content(const std::string& what) {
    if (!scanner_.next_content())
      scanner_.fail("the file ends where " + what + " should be: it is truncated");
  }

  std::int64_t count(const char* what) {
    const std::int64_t n = scanner_.integer(what);
    if (n < 0 || n >= std::numeric_limits<Index>::max())
      scanner_.fail(fmt::format("{} is given as {}, which cannot be", what, n));
    return n;
  }

  void vertex(std::int64_t v, std::int64_t of) {
    if (!scanner_.next_content())
      scanner_.fail(fmt::format("the file ends after {} of {} vertices: it is truncated", v, of));
    Vec3 p;
    p.x = scanner_.number("a coordinate");
    p.y = scanner_.number("a coordinate");
    p.z = scanner_.number("a coordinate");
    builder_.add_vertex(p, [&] { return scanner_.where(); });
    scanner_.next_line();
  }

  void face(std::int64_t f, std::int64_t of) {
    if (!scanner_.next_content())
      scanner_.fail(fmt::format("the file ends after {} of {} faces: it is truncated", f, of));
    const std::int64_t corners = scanner_.integer("the number of a face's corners");
    if (corners < 0) scanner_.fail(fmt::format("face {} is said to have {} corners", f, corners));
    corners_.clear();
    for (std::int64_t k = 0; k < corners; ++k) {
      const std::int64_t index = scanner_.integer("a vertex index");
      if (index < 0 || index >= builder_.vertex_count())
        scanner_.fail_invalid(
            fmt::format("face {} names vertex {}, which does not exist (OFF counts from 0; {} "
                        "vertices)",
                        f, index, builder_.vertex_count()),
            static_cast<Index>(f));
      corners_.push_back(static_cast<Index>(index));
    }
    builder_.add_face(corners_.data(), corners_.size());
    scanner_.next_line();
  }

  Scanner scanner_;
  MeshBuilder builder_;
  std::vector<Index> corners_;
};

}  // namespace

ReadResult read_off(const Source& source) { return OffReader(source).read(); }

std::string write_off(const TriangleMesh& mesh) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "OFF\n{} {} 0\n", mesh.vertices.size(),
                 mesh.triangles.size());
  for (const Vec3& p : mesh.vertices)
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("{} {} {}\n"), p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles)
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("3 {} {} {}\n"), t[0], t[1], t[2]);
  return fmt::to_string(out);
}

}  // namespace nonobtuse::io
