// The public calls: which format, then its reader or writer.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "attributes/validity.h"
#include "io/file.h"
#include "io/formats.h"
#include "nonobtuse/io.h"
#include "numeric/vec3.h"

namespace nonobtuse {

namespace {

using io::Scanner;
using io::Source;

std::optional<FileFormat> format_of_suffix(const std::string& path) {
  const std::size_t dot = path.find_last_of("./\\");
  if (dot == std::string::npos || path[dot] != '.') return std::nullopt;
  std::string suffix = path.substr(dot + 1);
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
  });
  if (suffix == "obj") return FileFormat::Obj;
  if (suffix == "off") return FileFormat::Off;
  if (suffix == "ply") return FileFormat::Ply;
  if (suffix == "stl") return FileFormat::Stl;
  return std::nullopt;
}

// Whether some line begins with "v ", as only those of an OBJ do.
bool has_obj_vertex(std::string_view bytes) {
  if (bytes.find('\0') != std::string_view::npos) return false;
  if (bytes.substr(0, 2) == "v ") return true;
  return bytes.find("\nv ") != std::string_view::npos;
}

// The content decides where it can, so that a wrong suffix does no harm.
FileFormat format_of_content(const Source& source) {
  Scanner scanner(source);
  if (!scanner.next_content()) throw IoError(source.name + ": the file is empty.");
  const std::string_view first = scanner.word();
  if (first == "ply") return FileFormat::Ply;
  if (first.size() >= 3 && first.size() <= 8 && first.substr(first.size() - 3) == "OFF")
    return FileFormat::Off;
  if (io::is_binary_stl(source.bytes)) return FileFormat::Stl;
  const std::optional<FileFormat> suffix = format_of_suffix(source.name);
  if (suffix == FileFormat::Obj) return FileFormat::Obj;
  if (first == "solid" || first == "SOLID") return FileFormat::Stl;
  if (has_obj_vertex(source.bytes)) return FileFormat::Obj;
  if (suffix) return *suffix;
  throw IoError(source.name + ": this is not an OBJ, OFF, PLY or STL file.");
}

FileFormat format_to_write(const std::string& path) {
  const std::optional<FileFormat> format = format_of_suffix(path);
  if (!format)
    throw IoError(path + ": cannot tell the format; end the name in .obj, .off, .ply or .stl.");
  return *format;
}

bool holds_floats(FileFormat format, const WriteOptions& options) {
  return format == FileFormat::Stl && options.binary;
}

void check_writable(const TriangleMesh& mesh, bool floats) {
  const double limit = floats ? static_cast<double>(std::numeric_limits<float>::max())
                              : std::numeric_limits<double>::max();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit) continue;
    throw InvalidInput(
        is_finite(p) ? "Vertex " + std::to_string(v) +
                           " is too large for the floats of a binary STL; write another format."
                     : "Vertex " + std::to_string(v) + " has a coordinate that is not finite.",
        static_cast<Index>(v));
  }
  const auto count = static_cast<Index>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t])
      if (v < 0 || v >= count)
        throw InvalidInput("Triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                               ", which does not exist.",
                           static_cast<Index>(t));
}

// A text of old Macs, whose lines end in a lone carriage return.
bool has_lone_returns(std::string_view bytes) {
  return bytes.find('\r') != std::string_view::npos && bytes.find('\n') == std::string_view::npos &&
         bytes.find('\0') == std::string_view::npos;
}

}  // namespace

ReadResult read_mesh_from_memory(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);  // byte order mark
  std::string copy;
  if (has_lone_returns(bytes)) {
    copy = bytes;
    std::replace(copy.begin(), copy.end(), '\r', '\n');
    bytes = copy;
  }
  const Source source{bytes, name};
  switch (format_of_content(source)) {
    case FileFormat::Obj:
      return io::read_obj(source);
    case FileFormat::Off:
      return io::read_off(source);
    case FileFormat::Ply:
      return io::read_ply(source);
    default:
      return io::read_stl(source);
  }
}

ReadResult read_mesh(const std::string& path) {
  return read_mesh_from_memory(io::read_file(path), path);
}

std::string write_mesh_to_memory(FileFormat format, const TriangleMesh& mesh,
                                 const WriteOptions& options) {
  return write_mesh_to_memory(format, mesh, MeshAttributes{}, options);
}

std::string write_mesh_to_memory(FileFormat format, const TriangleMesh& mesh,
                                 const MeshAttributes& attributes, const WriteOptions& options) {
  check_writable(mesh, holds_floats(format, options));
  attributes::require_valid(mesh, attributes);
  switch (format) {
    case FileFormat::Obj:
      return io::write_obj(mesh, attributes);
    case FileFormat::Off:
      return io::write_off(mesh);
    case FileFormat::Ply:
      return io::write_ply(mesh, attributes, options.binary);
    default:
      return io::write_stl(mesh, options.binary);
  }
}

void write_mesh(const std::string& path, const TriangleMesh& mesh, const WriteOptions& options) {
  io::write_file(path, write_mesh_to_memory(format_to_write(path), mesh, options));
}

void write_mesh(const std::string& path, const TriangleMesh& mesh, const MeshAttributes& attributes,
                const WriteOptions& options) {
  io::write_file(path, write_mesh_to_memory(format_to_write(path), mesh, attributes, options));
}

TriangleMesh as_written(const std::string& path, const TriangleMesh& mesh,
                        const WriteOptions& options) {
  const bool floats = holds_floats(format_to_write(path), options);
  check_writable(mesh, floats);
  TriangleMesh result = mesh;
  if (!floats) return result;
  // GCC 12.2 at -O3 drops the pair of conversions for the last elements of such a loop (its SLP
  // vectoriser), hence the volatile.
  const auto rounded = [](double x) {
    volatile float f = static_cast<float>(x);
    return static_cast<double>(f);
  };
  for (Vec3& p : result.vertices) p = {rounded(p.x), rounded(p.y), rounded(p.z)};
  return result;
}

}  // namespace nonobtuse
