// Wavefront OBJ: `v x y z [w] [r g b]` and `f v[/vt[/vn]] ...` with indices from 1, or negative
// ones counted back from the latest vertex. Lines are continued by a backslash.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <iterator>
#include <limits>

#include "io/formats.h"
#include "io/mesh_builder.h"

namespace nonobtuse::io {

namespace {

class ObjReader {
 public:
  explicit ObjReader(const Source& source) : scanner_(source), builder_(source) {
    // About 30 bytes a line: no reallocation for most files, never more than the file's own size.
    builder_.reserve(source.bytes.size() / 90, source.bytes.size() / 45);
  }

  ReadResult read() {
    while (scanner_.next_content()) {
      const char* const line = scanner_.position();
      const std::string_view keyword = scanner_.word();
      if (keyword == "v")
        vertex();
      else if (keyword == "f")
        face(line);
      scanner_.next_line();
    }
    for (const Forward& f : forward_)
      if (f.index >= builder_.vertex_count()) out_of_range(f.line, f.index + 1, f.face);
    return builder_.finish(FileFormat::Obj);
  }

 private:
  // A face may come before its vertices: such indices are checked at the end.
  struct Forward {
    std::int64_t index;
    const char* line;
    Index face;
  };

  void vertex() {
    Vec3 p;
    p.x = scanner_.number("a coordinate");
    p.y = scanner_.number("a coordinate");
    p.z = scanner_.number("a coordinate");
    builder_.add_vertex(p, [&] { return scanner_.where(); });
  }

  void face(const char* line) {
    corners_.clear();
    for (scanner_.skip_blanks(); !scanner_.at_line_end(); scanner_.skip_blanks()) {
      const std::int64_t written = scanner_.leading_integer("a vertex index");
      const std::int64_t count = builder_.vertex_count();
      const std::int64_t index = written > 0 ? written - 1 : count + written;
      if (written == 0 || index < 0 || index > std::numeric_limits<Index>::max())
        out_of_range(line, written, builder_.face_count());
      if (index >= count) forward_.push_back({index, line, builder_.face_count()});
      corners_.push_back(static_cast<Index>(index));
      const std::string_view rest = scanner_.rest_of_word();  // "/vt/vn"
      if (!rest.empty() && rest[0] != '/')
        scanner_.fail("a face corner is not of the form v, v/vt, v//vn or v/vt/vn");
    }
    builder_.add_face(corners_.data(), corners_.size());
  }

  [[noreturn]] void out_of_range(const char* line, std::int64_t written, Index face_index) {
    throw InvalidInput(
        fmt::format("{}face {} names vertex {}, which does not exist (OBJ counts from 1; {} "
                    "vertices so far).",
                    scanner_.where(line), face_index, written, builder_.vertex_count()),
        face_index);
  }

  Scanner scanner_;
  MeshBuilder builder_;
  std::vector<Index> corners_;
  std::vector<Forward> forward_;
};

}  // namespace

ReadResult read_obj(const Source& source) { return ObjReader(source).read(); }

std::string write_obj(const TriangleMesh& mesh) {
  fmt::memory_buffer out;
  for (const Vec3& p : mesh.vertices)
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("v {} {} {}\n"), p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles)
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("f {} {} {}\n"), t[0] + std::int64_t{1},
                   t[1] + std::int64_t{1}, t[2] + std::int64_t{1});
  return fmt::to_string(out);
}

}  // namespace nonobtuse::io
