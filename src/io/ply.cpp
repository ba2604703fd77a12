// Stanford PLY (Turk, The PLY polygon file format, 1994): a text header that declares elements and
// their properties, then the elements in ascii or in binary of either byte order. A vertex's x, y,
// z, colour and texture coordinates and a face's vertex indices, texture coordinates and label are
// read under their usual names; all else is skipped.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/mesh_builder.h"

namespace nonobtuse::io {

namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Float, Double };

struct TypeName {
  std::string_view name;
  Type type;
};

constexpr std::array<TypeName, 20> type_names{
    {{"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::Uint8},
     {"uint8", Type::Uint8},   {"short", Type::Int16},   {"int16", Type::Int16},
     {"ushort", Type::Uint16}, {"uint16", Type::Uint16}, {"int", Type::Int32},
     {"int32", Type::Int32},   {"uint", Type::Uint32},   {"uint32", Type::Uint32},
     {"int64", Type::Int64},   {"uint64", Type::Uint64}, {"float", Type::Float},
     {"float32", Type::Float}, {"double", Type::Double}, {"float64", Type::Double},
     {"long", Type::Int64},    {"ulong", Type::Uint64}}};

constexpr std::size_t size_of(Type type) {
  switch (type) {
    case Type::Int8:
    case Type::Uint8:
      return 1;
    case Type::Int16:
    case Type::Uint16:
      return 2;
    case Type::Int32:
    case Type::Uint32:
    case Type::Float:
      return 4;
    default:
      return 8;
  }
}

double load_as(Type type, const char* bytes, bool swap) {
  switch (type) {
    case Type::Int8:
      return load<std::int8_t>(bytes, swap);
    case Type::Uint8:
      return load<std::uint8_t>(bytes, swap);
    case Type::Int16:
      return load<std::int16_t>(bytes, swap);
    case Type::Uint16:
      return load<std::uint16_t>(bytes, swap);
    case Type::Int32:
      return load<std::int32_t>(bytes, swap);
    case Type::Uint32:
      return load<std::uint32_t>(bytes, swap);
    case Type::Int64:
      return static_cast<double>(load<std::int64_t>(bytes, swap));
    case Type::Uint64:
      return static_cast<double>(load<std::uint64_t>(bytes, swap));
    case Type::Float:
      return static_cast<double>(load<float>(bytes, swap));
    default:
      return load<double>(bytes, swap);
  }
}

enum class Role { Skipped, X, Y, Z, Red, Green, Blue, Alpha, U, V, Corners, Texture, Label };

struct RoleName {
  std::string_view name;
  Role role;
};

constexpr std::array<RoleName, 17> vertex_roles{{{"x", Role::X},
                                                 {"y", Role::Y},
                                                 {"z", Role::Z},
                                                 {"red", Role::Red},
                                                 {"green", Role::Green},
                                                 {"blue", Role::Blue},
                                                 {"alpha", Role::Alpha},
                                                 {"r", Role::Red},
                                                 {"g", Role::Green},
                                                 {"b", Role::Blue},
                                                 {"a", Role::Alpha},
                                                 {"u", Role::U},
                                                 {"v", Role::V},
                                                 {"s", Role::U},
                                                 {"t", Role::V},
                                                 {"texture_u", Role::U},
                                                 {"texture_v", Role::V}}};
constexpr std::array<RoleName, 4> label_names{{{"label", Role::Label},
                                               {"segment", Role::Label},
                                               {"group", Role::Label},
                                               {"material_index", Role::Label}}};

struct Property {
  Role role = Role::Skipped;
  Type type = Type::Float;
  bool is_list = false;
  Type count_type = Type::Uint8;
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
  bool is_vertex = false;
  bool is_face = false;

  // Bytes that one element takes at least; in ascii a number and a blank for each property.
  [[nodiscard]] std::size_t least_size(bool ascii) const {
    std::size_t size = 0;
    for (const Property& p : properties)
      size += ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
    return size;
  }
};

enum class Encoding { Ascii, Little, Big };

struct Header {
  Encoding encoding = Encoding::Ascii;
  std::vector<Element> elements;
};

Type type_named(Scanner& scanner) {
  const std::string_view word = scanner.word();
  for (const TypeName& t : type_names)
    if (t.name == word) return t.type;
  scanner.fail("a property has a type that PLY does not know");
}

Property read_property(Scanner& scanner, const Element& element) {
  Property p;
  const char* const start = scanner.position();
  p.is_list = scanner.word() == "list";
  if (p.is_list) {
    p.count_type = type_named(scanner);
  } else {
    scanner.set_position(start);
  }
  p.type = type_named(scanner);
  const std::string_view name = scanner.word();
  if (element.is_vertex && !p.is_list)
    for (const RoleName& r : vertex_roles)
      if (r.name == name) p.role = r.role;
  if (element.is_face && !p.is_list)
    for (const RoleName& r : label_names)
      if (r.name == name) p.role = r.role;
  if (element.is_face && p.is_list && (name == "vertex_indices" || name == "vertex_index"))
    p.role = Role::Corners;
  if (element.is_face && p.is_list && name == "texcoord") p.role = Role::Texture;
  return p;
}

Encoding read_encoding(Scanner& scanner) {
  const std::string_view word = scanner.word();
  if (word == "ascii") return Encoding::Ascii;
  if (word == "binary_little_endian") return Encoding::Little;
  if (word == "binary_big_endian") return Encoding::Big;
  scanner.fail("the format of a PLY file is ascii, binary_little_endian or binary_big_endian");
}

Header read_header(Scanner& scanner) {
  Header header;
  bool has_format = false;
  scanner.skip_blanks();
  if (scanner.word() != "ply") scanner.fail("the file does not begin with the word ply");
  for (;;) {
    scanner.next_line();
    scanner.skip_blanks();
    if (scanner.at_end()) scanner.fail("the file ends inside its header: it is truncated");
    const std::string_view keyword = scanner.word();
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.encoding = read_encoding(scanner);
      has_format = true;
    } else if (keyword == "element") {
      Element element;
      element.name = scanner.word();
      element.count = scanner.integer("the number of elements");
      element.is_vertex = element.name == "vertex";
      element.is_face = element.name == "face";
      if (element.count < 0) scanner.fail("a number of elements is negative");
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) scanner.fail("a property comes before any element");
      scanner.skip_blanks();
      header.elements.back().properties.push_back(read_property(scanner, header.elements.back()));
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      scanner.fail("this line does not belong into the header of a PLY file");
    }
  }
  if (!has_format) scanner.fail("the header does not say the format (ascii or binary)");
  scanner.next_line();
  return header;
}

class PlyReader {
 public:
  explicit PlyReader(const Source& source) : source_(source), scanner_(source), builder_(source) {}

  ReadResult read() {
    const Header header = read_header(scanner_);
    ascii_ = header.encoding == Encoding::Ascii;
    swap_ = (header.encoding == Encoding::Little) != little_endian_machine;
    bool has_vertices = false;
    for (const Element& element : header.elements) {
      check(element);
      if (element.properties.empty()) continue;
      if (element.is_vertex || element.is_face) {
        const auto count = static_cast<std::size_t>(element.count);
        element.is_vertex ? builder_.reserve(count, 0) : builder_.reserve(0, count);
      }
      has_vertices = has_vertices || element.is_vertex;
      for (std::int64_t i = 0; i < element.count; ++i) read_element(element, i);
    }
    if (!has_vertices) throw IoError(source_.name + ": the header declares no vertices.");
    for (std::size_t c = 0; c < face_places_.size(); ++c)
      if (face_places_[c].largest >= builder_.vertex_count())
        out_of_range(face_places_[c].face, face_places_[c].largest, face_places_[c].place);
    return builder_.finish(FileFormat::Ply);
  }

 private:
  // A face that names a vertex not read yet (elements may come in any order).
  struct FacePlace {
    Index face;
    Index largest;
    const char* place;
  };

  void check(const Element& element) const {
    int coordinates = 0;
    for (const Property& p : element.properties)
      if (p.role == Role::X || p.role == Role::Y || p.role == Role::Z) ++coordinates;
    if (element.is_vertex && coordinates != 3)
      throw IoError(source_.name + ": the vertices have no properties x, y and z.");
    const std::size_t least = element.least_size(ascii_);
    // The last number of an ascii file may lack its line end.
    if (least > 0 && static_cast<std::uint64_t>(element.count) > (scanner_.remaining() + 1) / least)
      throw IoError(
          fmt::format("{}{} elements '{}' are announced, more than fit in the {} bytes "
                      "that follow: the file is truncated.",
                      where(scanner_.position()), element.count, printable(element.name),
                      scanner_.remaining()));
    if ((element.is_vertex || element.is_face) &&
        element.count >= std::numeric_limits<Index>::max())
      throw IoError(source_.name + ": there are too many elements for 32-bit indices.");
  }

  static std::string printable(const std::string& name) {
    std::string out;
    for (const char c : name.substr(0, 20)) out += c >= ' ' && c < 127 ? c : '?';
    return out;
  }

  [[nodiscard]] std::string where(const char* place) const {
    return ascii_ ? scanner_.where(place)
                  : fmt::format("{}, byte {}: ", source_.name, place - source_.bytes.data());
  }

  double value(Type type, const Element& element, std::int64_t i) {
    if (ascii_) {
      if (!scanner_.next_content()) ends(element, i);
      return scanner_.number("a number");
    }
    const std::size_t size = size_of(type);
    if (scanner_.remaining() < size) ends(element, i);
    const double v = load_as(type, scanner_.position(), swap_);
    scanner_.set_position(scanner_.position() + size);
    return v;
  }

  [[noreturn]] void ends(const Element& element, std::int64_t i) const {
    throw IoError(fmt::format("{}the file ends in element {} of {} of '{}': it is truncated.",
                              where(scanner_.position()), i, element.count,
                              printable(element.name)));
  }

  void read_element(const Element& element, std::int64_t i) {
    const char* const place = start_of_element();
    Vec3 p;
    Color color{0, 0, 0, 1};
    TextureCoordinate texture{};
    unsigned roles = 0;
    corners_.clear();
    face_texture_.clear();
    for (const Property& property : element.properties) {
      if (property.is_list) {
        read_list(property, element, i, place);
        continue;
      }
      const double v = value(property.type, element, i);
      if (property.role == Role::X) p.x = v;
      if (property.role == Role::Y) p.y = v;
      if (property.role == Role::Z) p.z = v;
      if (property.role >= Role::Red && property.role <= Role::Alpha)
        color[static_cast<std::size_t>(property.role) - static_cast<std::size_t>(Role::Red)] =
            v / largest_of(property.type);
      if (property.role == Role::U) texture[0] = v;
      if (property.role == Role::V) texture[1] = v;
      if (property.role == Role::Label && v >= 0 && v < std::numeric_limits<Index>::max())
        builder_.set_label(static_cast<Index>(v));
      roles |= 1U << static_cast<unsigned>(property.role);
    }
    const auto has = [&](Role role) { return (roles >> static_cast<unsigned>(role) & 1U) != 0; };
    if (element.is_vertex) {
      builder_.add_vertex(p, [&] { return where(place); });
      if (has(Role::Red) && has(Role::Green) && has(Role::Blue)) builder_.add_color(color);
      if (has(Role::U) && has(Role::V)) {
        by_vertex_ = true;
        builder_.add_texture_coordinate(texture);
      }
    }
    if (element.is_face && has_corners_) add_face();
  }

  // Texture coordinates of a face's own come before those of its vertices.
  void add_face() {
    has_corners_ = false;
    if (face_texture_.size() == 2 * corners_.size() && !by_vertex_) {
      texture_.clear();
      for (std::size_t k = 0; k < corners_.size(); ++k) {
        texture_.push_back(builder_.texture_coordinate_count());
        builder_.add_texture_coordinate({face_texture_[2 * k], face_texture_[2 * k + 1]});
      }
      builder_.add_face(corners_.data(), corners_.size(), texture_.data());
      return;
    }
    builder_.add_face(corners_.data(), corners_.size(), by_vertex_ ? corners_.data() : nullptr);
  }

  // What an integer type stands for as a colour; 1 for floats.
  static double largest_of(Type type) {
    if (type == Type::Uint8) return 255;
    if (type == Type::Uint16) return 65535;
    if (type == Type::Float || type == Type::Double) return 1;
    return std::ldexp(1.0, static_cast<int>(8 * size_of(type) - 1)) - 1;
  }

  const char* start_of_element() {
    if (ascii_) scanner_.next_content();
    return scanner_.position();
  }

  void read_list(const Property& property, const Element& element, std::int64_t i,
                 const char* place) {
    const double count = value(property.count_type, element, i);
    const std::size_t least = ascii_ ? 2 : size_of(property.type);
    if (!(count >= 0) || count > static_cast<double>((scanner_.remaining() + 1) / least) ||
        count != static_cast<double>(static_cast<std::int64_t>(count)))
      throw IoError(fmt::format("{}element {} of '{}' has a list of {} entries, which cannot be.",
                                where(place), i, printable(element.name), count));
    const auto n = static_cast<std::size_t>(count);
    if (property.role == Role::Texture) {
      for (std::size_t k = 0; k < n; ++k) face_texture_.push_back(value(property.type, element, i));
      return;
    }
    if (property.role != Role::Corners) {
      for (std::size_t k = 0; k < n; ++k) value(property.type, element, i);
      return;
    }
    corners_.resize(n);
    Index largest = -1;
    for (Index& corner : corners_) {
      const double v = value(property.type, element, i);
      if (!(v >= 0) || v >= std::numeric_limits<Index>::max() ||
          v != static_cast<double>(static_cast<Index>(v)))
        out_of_range(builder_.face_count(), v, place);
      corner = static_cast<Index>(v);
      largest = std::max(largest, corner);
    }
    if (largest >= builder_.vertex_count())
      face_places_.push_back({builder_.face_count(), largest, place});
    has_corners_ = true;
  }

  [[noreturn]] void out_of_range(Index face, double index, const char* place) const {
    throw InvalidInput(
        fmt::format("{}face {} names vertex {}, which does not exist (PLY counts from 0; {} "
                    "vertices).",
                    where(place), face, index, builder_.vertex_count()),
        face);
  }

  const Source& source_;
  Scanner scanner_;
  MeshBuilder builder_;
  bool ascii_ = true;
  bool swap_ = false;
  std::vector<Index> corners_;
  std::vector<double> face_texture_;
  std::vector<Index> texture_;
  bool has_corners_ = false;
  bool by_vertex_ = false;  // texture coordinates belong to vertices
  std::vector<FacePlace> face_places_;
};

std::string header_of(const TriangleMesh& mesh, const MeshAttributes& attributes, bool alpha,
                      bool binary) {
  std::string header = fmt::format(
      "ply\nformat {} 1.0\ncomment by nonobtuse\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\n",
      binary ? "binary_little_endian" : "ascii", mesh.vertices.size());
  if (!attributes.colors.empty())
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (alpha) header += "property uchar alpha\n";
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                        mesh.triangles.size());
  if (!attributes.texture_triangles.empty()) header += "property list uchar float texcoord\n";
  if (!attributes.labels.empty()) header += "property int label\n";
  return header + "end_header\n";
}

// Writes the numbers of one element after the other.
class PlyWriter {
 public:
  PlyWriter(std::string& out, bool binary) : out_(out), binary_(binary) {}

  template <class T>
  void add(T value) {
    if (binary_) {
      store(out_, value);
      return;
    }
    if (!first_) out_ += ' ';
    first_ = false;
    fmt::format_to(std::back_inserter(out_), FMT_COMPILE("{}"), value);
  }
  void end_element() {
    if (!binary_) out_ += '\n';
    first_ = true;
  }

 private:
  std::string& out_;
  bool binary_;
  bool first_ = true;
};

std::uint8_t byte_of(double channel) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
}

}  // namespace

ReadResult read_ply(const Source& source) { return PlyReader(source).read(); }

std::string write_ply(const TriangleMesh& mesh, const MeshAttributes& attributes, bool binary) {
  const bool alpha = std::any_of(attributes.colors.begin(), attributes.colors.end(),
                                 [](const Color& c) { return c[3] != 1; });
  std::string out = header_of(mesh, attributes, alpha, binary);
  out.reserve(out.size() + (binary ? 24 : 56) * mesh.vertices.size() +
              (binary ? 13 : 22) * mesh.triangles.size());
  PlyWriter writer(out, binary);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    for (const double x : {p.x, p.y, p.z}) writer.add(x);
    if (!attributes.colors.empty())
      for (std::size_t c = 0; c < (alpha ? 4 : 3); ++c)
        writer.add(byte_of(attributes.colors[v][c]));
    writer.end_element();
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    writer.add(std::uint8_t{3});
    for (const Index v : mesh.triangles[t]) writer.add(v);
    if (!attributes.texture_triangles.empty()) {
      const Triangle& texture = attributes.texture_triangles[t];
      writer.add(static_cast<std::uint8_t>(texture[0] < 0 ? 0 : 6));
      for (const Index i : texture)
        for (int c = 0; c < 2 && i >= 0; ++c)
          writer.add(static_cast<float>(attributes.texture_coordinates[i][c]));
    }
    if (!attributes.labels.empty()) writer.add(attributes.labels[t]);
    writer.end_element();
  }
  return out;
}

}  // namespace nonobtuse::io
