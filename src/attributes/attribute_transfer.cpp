// Attributes of a remeshed surface. Colours are interpolated at the vertices' nearest points.
// Labels and textures belong to faces: the input's facet nearest to a face's centroid says which
// part of it the face stands for. A texture is not continuous across its seams, so that a corner is
// looked up from inside its face: from that facet the search goes on towards the corner, never
// across a seam.
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "attributes/validity.h"
#include "mesh/surface.h"
#include "nonobtuse/error.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse {

namespace {

constexpr int kPatience = 32;  // facets looked at around a corner without getting any nearer
constexpr double kSameTexture = 1e-7;  // relative: corners that differ less share a coordinate

// The power of two that brings the largest coordinate to about 1: the search squares them.
double unit_scale(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Vec3& v : mesh.vertices)
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -exponent);
}

TriangleMesh scaled(TriangleMesh mesh, double scale) {
  for (Vec3& v : mesh.vertices) v *= scale;
  return mesh;
}

class Transfer {
 public:
  Transfer(const TriangleMesh& mesh, const MeshAttributes& attributes, const TriangleMesh& result)
      : scale_(unit_scale(mesh)),
        mesh_(scaled(mesh, scale_)),
        result_(scaled(result, scale_)),
        attributes_(attributes),
        bvh_(mesh_.vertices, mesh_.triangles, parallel::Workers(1)) {
    for (const Triangle& t : mesh_.triangles) normals_.push_back(normal_of(mesh_, t));
    if (!attributes.texture_triangles.empty())
      adjacent_ =
          mesh::triangle_adjacency(mesh_.triangles, static_cast<Index>(mesh_.vertices.size()));
    seen_.assign(mesh_.triangles.size(), 0);
  }

  void run(MeshAttributes& out) {
    std::vector<std::vector<Index>> at_vertex(result_.vertices.size());  // texture coordinates
    for (const Triangle& face : result_.triangles) {
      const Vec3 normal = normal_of(result_, face);
      const Vec3 centroid =
          (result_.vertices[face[0]] + result_.vertices[face[1]] + result_.vertices[face[2]]) / 3;
      const Index facet = nearest_facet(centroid, normal);
      if (!attributes_.labels.empty()) out.labels.push_back(attributes_.labels[facet]);
      if (attributes_.texture_triangles.empty()) continue;
      Triangle texture{-1, -1, -1};
      if (has_texture(facet))
        for (int k = 0; k < 3; ++k)
          texture[k] = add_coordinate(corner_texture(result_.vertices[face[k]], facet),
                                      at_vertex[face[k]], out.texture_coordinates);
      out.texture_triangles.push_back(texture);
    }
  }

 private:
  static Vec3 normal_of(const TriangleMesh& mesh, const Triangle& t) {
    return area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }

  [[nodiscard]] bool has_texture(Index facet) const {
    const Triangle& t = attributes_.texture_triangles[facet];
    return *std::min_element(t.begin(), t.end()) >= 0;
  }

  // The nearest facet that faces the same way; a plain nearest one may be on the other side of a
  // thin sheet.
  [[nodiscard]] Index nearest_facet(const Vec3& p, const Vec3& normal) const {
    const auto any = bvh_.closest(p);
    if (dot(normals_[any.triangle], normal) > 0) return any.triangle;
    const double reach = 4 * any.squared_distance + length(normal);  // an edge, about
    const auto hit =
        bvh_.closest_if(p, reach, [&](Index t) { return dot(normals_[t], normal) > 0; });
    return hit.triangle >= 0 ? hit.triangle : any.triangle;
  }

  // The texture coordinate at p for a face that stands for `facet`: of the point nearest to p that
  // can be reached from there without crossing a seam. Best first: from facet to facet, those
  // nearest to p before others, until a number of them has brought nothing nearer.
  TextureCoordinate corner_texture(const Vec3& p, Index facet) {
    Index best = -1;
    spatial::ClosestPoint best_point;
    ++stamp_;
    open_.clear();
    const auto look_at = [&](Index f) {
      seen_[f] = stamp_;
      const spatial::ClosestPoint point = closest_point(f, p);
      open_.emplace_back(point.squared_distance, f);
      std::push_heap(open_.begin(), open_.end(), std::greater<>());
      if (best >= 0 &&
          !(std::pair(point.squared_distance, f) < std::pair(best_point.squared_distance, best)))
        return false;
      best = f;
      best_point = point;
      return true;
    };
    look_at(facet);
    for (int idle = 0; idle < kPatience && !open_.empty() && best_point.squared_distance > 0;
         ++idle) {
      std::pop_heap(open_.begin(), open_.end(), std::greater<>());
      const Index f = open_.back().second;
      open_.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Index next = adjacent_[f][k];
        if (next < 0 || seen_[next] == stamp_ || !has_texture(next) ||
            attributes::is_seam(mesh_, attributes_, f, k, next))
          continue;
        if (look_at(next)) idle = 0;
      }
    }
    return interpolated(best, best_point.barycentric);
  }

  [[nodiscard]] spatial::ClosestPoint closest_point(Index facet, const Vec3& p) const {
    const Triangle& t = mesh_.triangles[facet];
    return spatial::closest_point_on_triangle(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                              mesh_.vertices[t[2]]);
  }

  [[nodiscard]] TextureCoordinate interpolated(Index facet, const Vec3& w) const {
    const Triangle& t = attributes_.texture_triangles[facet];
    if (!has_texture(facet)) return {0, 0};
    TextureCoordinate result{};
    for (int c = 0; c < 2; ++c)
      result[c] = w.x * attributes_.texture_coordinates[t[0]][c] +
                  w.y * attributes_.texture_coordinates[t[1]][c] +
                  w.z * attributes_.texture_coordinates[t[2]][c];
    return result;
  }

  // The number of a coordinate at a vertex: that of one which is there already, or a new one.
  static Index add_coordinate(const TextureCoordinate& at, std::vector<Index>& at_vertex,
                              std::vector<TextureCoordinate>& all) {
    for (const Index i : at_vertex) {
      const double difference = std::max(std::abs(all[i][0] - at[0]), std::abs(all[i][1] - at[1]));
      if (difference <= kSameTexture * std::max({1.0, std::abs(at[0]), std::abs(at[1])})) return i;
    }
    all.push_back(at);
    at_vertex.push_back(static_cast<Index>(all.size()) - 1);
    return at_vertex.back();
  }

  double scale_;
  TriangleMesh mesh_;
  TriangleMesh result_;
  const MeshAttributes& attributes_;
  spatial::TriangleBvh bvh_;
  std::vector<Vec3> normals_;
  std::vector<std::array<Index, 3>> adjacent_;
  std::vector<int> seen_;  // last search that looked at a facet
  int stamp_ = 0;
  std::vector<std::pair<double, Index>> open_;  // a heap: to be looked at next
};

}  // namespace

MeshAttributes transfer_attributes(const TriangleMesh& mesh, const MeshAttributes& attributes,
                                   const RemeshResult& result) {
  attributes::require_valid(mesh, attributes);
  if (result.source_triangle.size() != result.mesh.vertices.size() ||
      result.barycentric.size() != result.mesh.vertices.size())
    throw InvalidInput("The result does not say where its vertices come from.");
  MeshAttributes out;
  out.label_names = attributes.label_names;
  out.labels_are_groups = attributes.labels_are_groups;
  out.material_library = attributes.material_library;
  for (std::size_t v = 0; v < result.mesh.vertices.size() && !attributes.colors.empty(); ++v) {
    const Triangle& t = mesh.triangles[result.source_triangle[v]];
    const Vec3& w = result.barycentric[v];
    Color color{};
    for (int c = 0; c < 4; ++c)
      color[c] = w.x * attributes.colors[t[0]][c] + w.y * attributes.colors[t[1]][c] +
                 w.z * attributes.colors[t[2]][c];
    out.colors.push_back(color);
  }
  if (!attributes.labels.empty() || !attributes.texture_triangles.empty())
    Transfer(mesh, attributes, result.mesh).run(out);
  return out;
}

}  // namespace nonobtuse
