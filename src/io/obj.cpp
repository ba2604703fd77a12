// Wavefront OBJ: `v x y z [r g b]`, `vt u v` and `f v[/vt[/vn]] ...` with indices from 1, or
// negative ones counted back from the latest vertex; `usemtl` and `g` name the faces that follow.
// Lines are continued by a backslash.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

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
      else if (keyword == "vt")
        texture_coordinate();
      else if (keyword == "usemtl" || keyword == "g")
        name_faces(keyword == "usemtl");
      else if (keyword == "mtllib")
        builder_.attributes().material_library = rest_of_line();
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
    scanner_.skip_blanks();
    if (scanner_.at_line_end()) return;
    std::array<double, 4> more{};
    std::size_t count = 0;
    for (; count < 4 && optional_number(more[count]); ++count) continue;
    // Three more numbers are a colour; one is the weight w, which nobody means.
    if (count == 3) builder_.add_color({more[0], more[1], more[2], 1});
    if (count == 4) builder_.add_color({more[1], more[2], more[3], 1});
  }

  // What is no number ends an optional part; complaining would refuse meshes that are fine.
  bool optional_number(double& value) {
    scanner_.skip_blanks();
    if (scanner_.at_line_end()) return false;
    const std::string_view word = scanner_.rest_of_word();
    const auto [rest, error] =
        fast_float::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && rest == word.data() + word.size() && std::isfinite(value);
  }

  void texture_coordinate() {
    TextureCoordinate at{};
    for (double& value : at)
      if (!optional_number(value)) value = 0;
    builder_.add_texture_coordinate(at);
  }

  std::string rest_of_line() {
    scanner_.skip_blanks();
    std::string text;
    while (!scanner_.at_line_end()) {
      const std::string_view word = scanner_.rest_of_word();
      if (word.empty()) {  // a control character
        scanner_.set_position(scanner_.position() + 1);
      } else {
        if (!text.empty()) text += ' ';
        text += word;
      }
      scanner_.skip_blanks();
    }
    return text;
  }

  // Labels are materials, or groups as long as there is no material.
  void name_faces(bool material) {
    if (materials_ && !material) return;
    if (material && !materials_) {
      materials_ = true;
      builder_.attributes().labels_are_groups = false;
      builder_.attributes().label_names.clear();
      builder_.forget_labels();
    }
    if (!material) builder_.attributes().labels_are_groups = true;
    std::vector<std::string>& names = builder_.attributes().label_names;
    if (names.empty() && builder_.face_count() > 0) names.emplace_back();  // of the faces before
    const std::string name = rest_of_line();
    const auto [it, added] =
        label_of_.try_emplace({material, name}, static_cast<Index>(names.size()));
    if (added) names.push_back(name);
    builder_.set_label(it->second);
  }

  void face(const char* line) {
    corners_.clear();
    texture_.clear();
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
      texture_.push_back(texture_index(rest));
    }
    const bool textured =
        std::any_of(texture_.begin(), texture_.end(), [](Index i) { return i >= 0; });
    builder_.add_face(corners_.data(), corners_.size(), textured ? texture_.data() : nullptr);
  }

  // Of "/vt/vn" or "//vn"; -1 if there is none. Out of range: found out later.
  [[nodiscard]] Index texture_index(std::string_view rest) const {
    if (rest.size() < 2) return -1;
    Index written = 0;
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), written);
    if (error != std::errc() || written == 0) return -1;
    return written > 0 ? written - 1 : builder_.texture_coordinate_count() + written;
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
  std::vector<Index> texture_;
  bool materials_ = false;
  std::map<std::pair<bool, std::string>, Index> label_of_;
  std::vector<Forward> forward_;
};

std::string label_name(const MeshAttributes& attributes, Index label) {
  const auto i = static_cast<std::size_t>(label);
  if (i < attributes.label_names.size() && !attributes.label_names[i].empty())
    return attributes.label_names[i];
  return "label_" + std::to_string(label);
}

}  // namespace

ReadResult read_obj(const Source& source) { return ObjReader(source).read(); }

std::string write_obj(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  if (!attributes.material_library.empty())
    fmt::format_to(to, FMT_COMPILE("mtllib {}\n"), attributes.material_library);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (attributes.colors.empty()) {
      fmt::format_to(to, FMT_COMPILE("v {} {} {}\n"), p.x, p.y, p.z);
    } else {
      const Color& c = attributes.colors[v];
      fmt::format_to(to, FMT_COMPILE("v {} {} {} {} {} {}\n"), p.x, p.y, p.z, c[0], c[1], c[2]);
    }
  }
  for (const TextureCoordinate& at : attributes.texture_coordinates)
    fmt::format_to(to, FMT_COMPILE("vt {} {}\n"), at[0], at[1]);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!attributes.labels.empty() && (f == 0 || attributes.labels[f] != attributes.labels[f - 1]))
      fmt::format_to(to, FMT_COMPILE("{} {}\n"), attributes.labels_are_groups ? "g" : "usemtl",
                     label_name(attributes, attributes.labels[f]));
    const Triangle& t = mesh.triangles[f];
    if (attributes.texture_triangles.empty() || attributes.texture_triangles[f][0] < 0) {
      fmt::format_to(to, FMT_COMPILE("f {} {} {}\n"), t[0] + std::int64_t{1},
                     t[1] + std::int64_t{1}, t[2] + std::int64_t{1});
    } else {
      const Triangle& c = attributes.texture_triangles[f];
      fmt::format_to(to, FMT_COMPILE("f {}/{} {}/{} {}/{}\n"), t[0] + std::int64_t{1},
                     c[0] + std::int64_t{1}, t[1] + std::int64_t{1}, c[1] + std::int64_t{1},
                     t[2] + std::int64_t{1}, c[2] + std::int64_t{1});
    }
  }
  return fmt::to_string(out);
}

}  // namespace nonobtuse::io
