// STL: facets of three points each, ascii ("solid ... endsolid", several of them) or binary (80
// bytes, a 32-bit count, 50 bytes per facet, little endian). Many binary files begin with "solid"
// too, so the size decides.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/mesh_builder.h"

namespace nonobtuse::io {

namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t prelude_size = 84;
constexpr std::size_t facet_size = 50;

// Three points per facet.
using Corners = std::vector<Vec3>;

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
  return word.size() == lower.size() &&
         std::equal(word.begin(), word.end(), lower.begin(), [](char a, char b) {
           return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b;
         });
}

class AsciiStlReader {
 public:
  explicit AsciiStlReader(const Source& source) : scanner_(source) {}

  Corners read() {
    while (scanner_.next_content()) {
      const std::string_view word = scanner_.word();
      const auto is = [&](std::string_view lower) { return equals_ignoring_case(word, lower); };
      if (is("vertex")) {
        vertex();
      } else if (is("endfacet")) {
        if (in_facet_ != 3)
          scanner_.fail(fmt::format("a facet has {} corners instead of three", in_facet_));
        in_facet_ = 0;
      } else if (is("solid") || is("endsolid")) {
        open_ = is("solid");
        if (in_facet_ != 0) scanner_.fail("a facet is not closed by endfacet");
        scanner_.next_line();
      } else if (is("normal")) {
        // Not used: the order of the corners says what is outside, and normals are often wrong.
        for (int k = 0; k < 3; ++k) scanner_.word();
      } else if (!is("facet") && !is("outer") && !is("loop") && !is("endloop")) {
        scanner_.fail("this is not a line of an ascii STL file");
      }
    }
    if (open_ || in_facet_ != 0) scanner_.fail("the file ends before endsolid: it is truncated");
    return std::move(corners_);
  }

 private:
  void vertex() {
    Vec3 p;
    p.x = scanner_.number("a coordinate");
    p.y = scanner_.number("a coordinate");
    p.z = scanner_.number("a coordinate");
    const auto facet = static_cast<Index>(corners_.size() / 3);
    if (!is_finite(p))
      scanner_.fail_invalid(fmt::format("facet {} has a coordinate that is not finite", facet),
                            facet);
    if (++in_facet_ > 3) scanner_.fail("a facet has more than three corners");
    corners_.push_back(p);
  }

  Scanner scanner_;
  Corners corners_;
  int in_facet_ = 0;
  bool open_ = false;
};

Corners read_binary(const Source& source) {
  const std::string_view bytes = source.bytes;
  if (bytes.size() < prelude_size)
    throw IoError(fmt::format("{}: {} bytes are too few for an STL file; it is truncated.",
                              source.name, bytes.size()));
  const auto facets = load<std::uint32_t>(bytes.data() + header_size, !little_endian_machine);
  const std::size_t present = (bytes.size() - prelude_size) / facet_size;
  if (facets > present)
    throw IoError(
        fmt::format("{}: {} facets are announced at byte {}, but only {} are there; "
                    "the file is truncated.",
                    source.name, facets, header_size, present));
  Corners corners(std::size_t{3} * facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const char* const facet = bytes.data() + prelude_size + facet_size * f;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto coordinate = [&](std::size_t axis) {
        return static_cast<double>(
            load<float>(facet + 12 * (k + 1) + 4 * axis, !little_endian_machine));
      };
      const Vec3 p{coordinate(0), coordinate(1), coordinate(2)};
      if (!is_finite(p))
        throw InvalidInput(
            fmt::format("{}: facet {} (byte {}) has a coordinate that is not finite.", source.name,
                        f, prelude_size + facet_size * f),
            static_cast<Index>(f));
      corners[3 * f + k] = p;
    }
  }
  return corners;
}

// vertex[c]: vertex of corner c. Equal corners are found by sorting, so the result depends on the
// order of the file alone.
ReadResult weld(const Corners& corners) {
  struct Entry {
    Vec3 p;
    Index corner;
  };
  std::vector<Entry> sorted(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c) sorted[c] = {corners[c], static_cast<Index>(c)};
  std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.p.x, a.p.y, a.p.z, a.corner) < std::tie(b.p.x, b.p.y, b.p.z, b.corner);
  });
  std::vector<Index> first(corners.size());  // earliest corner at the same place
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool same = i > 0 && sorted[i].p == sorted[i - 1].p;
    first[sorted[i].corner] = same ? first[sorted[i - 1].corner] : sorted[i].corner;
  }
  ReadResult result;
  std::vector<Index> vertex(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (first[c] == static_cast<Index>(c)) {
      vertex[c] = static_cast<Index>(result.mesh.vertices.size());
      result.mesh.vertices.push_back(corners[c]);
    } else {
      vertex[c] = vertex[first[c]];
    }
  }
  for (std::size_t c = 0; c < corners.size(); c += 3)
    result.mesh.triangles.push_back({vertex[c], vertex[c + 1], vertex[c + 2]});
  const auto welded = static_cast<Index>(corners.size() - result.mesh.vertices.size());
  Index first_welded = 0;
  while (welded > 0 && first[first_welded] == first_welded) ++first_welded;
  if (welded > 0) result.repairs.push_back({"equal facet corners welded", welded, first_welded});
  return result;
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < prelude_size) return false;
  const auto facets = load<std::uint32_t>(bytes.data() + header_size, !little_endian_machine);
  return bytes.size() == prelude_size + facet_size * std::size_t{facets};
}

ReadResult read_stl(const Source& source) {
  Scanner scanner(source);
  scanner.next_content();
  const bool solid = equals_ignoring_case(scanner.word(), "solid");
  const bool text = source.bytes.substr(0, 1024).find('\0') == std::string_view::npos;
  const bool ascii = solid && text && !is_binary_stl(source.bytes);
  const Corners corners = ascii ? AsciiStlReader(source).read() : read_binary(source);
  if (corners.empty()) throw IoError(source.name + ": there are no facets in this file.");
  if (corners.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw IoError(source.name + ": there are too many facets for 32-bit indices.");
  ReadResult result = weld(corners);
  result.format = FileFormat::Stl;
  return result;
}

std::string write_stl(const TriangleMesh& mesh, bool binary) {
  const auto normal_of = [&](const Triangle& t) {
    return normalized(area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  };
  if (!binary) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "solid nonobtuse\n");
    for (const Triangle& t : mesh.triangles) {
      const Vec3 n = normal_of(t);
      fmt::format_to(to, FMT_COMPILE("facet normal {} {} {}\nouter loop\n"), n.x, n.y, n.z);
      for (const Index v : t) {
        const Vec3& p = mesh.vertices[v];
        fmt::format_to(to, FMT_COMPILE("vertex {} {} {}\n"), p.x, p.y, p.z);
      }
      fmt::format_to(to, "endloop\nendfacet\n");
    }
    fmt::format_to(to, "endsolid nonobtuse\n");
    return fmt::to_string(out);
  }
  std::string out = "binary STL by nonobtuse";
  out.resize(header_size, ' ');
  out.reserve(prelude_size + facet_size * mesh.triangles.size());
  store(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto store_vector = [&](const Vec3& p) {
    store(out, static_cast<float>(p.x));
    store(out, static_cast<float>(p.y));
    store(out, static_cast<float>(p.z));
  };
  for (const Triangle& t : mesh.triangles) {
    store_vector(normal_of(t));
    for (const Index v : t) store_vector(mesh.vertices[v]);
    store(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace nonobtuse::io
