// Figures of Table 1 of Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation,
// TVCG 2016.
#include "quality/angles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/sector_valence.h"
#include "mesh/surface.h"
#include "nonobtuse/quality.h"
#include "numeric/predicates.h"
#include "numeric/vec3.h"
#include "quality/edges.h"
#include "quality/validity.h"

namespace nonobtuse {

namespace quality {

namespace {

// Exponent e with 2^(e - 1) <= largest coordinate < 2^e; 0 if all are 0.
int exponent_of(const Vec3& v) {
  int exponent = 0;
  std::frexp(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), &exponent);
  return exponent;
}

Vec3 times_power_of_two(const Vec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

bool usual(double squared) { return squared > 1e-120 && squared < 1e120; }

// Edges opposite corners 0, 1, 2; rescaled only where products could over- or underflow.
std::array<Vec3, 3> edges_of(Vec3 a, Vec3 b, Vec3 c) {
  std::array<Vec3, 3> e{c - b, a - c, b - a};
  if (usual(squared_length(e[0])) && usual(squared_length(e[1])) && usual(squared_length(e[2])))
    return e;
  const int large = std::max({exponent_of(a), exponent_of(b), exponent_of(c)});
  a = times_power_of_two(a, -large);
  b = times_power_of_two(b, -large);
  c = times_power_of_two(c, -large);
  e = {c - b, a - c, b - a};
  const int size = std::max({exponent_of(e[0]), exponent_of(e[1]), exponent_of(e[2])});
  for (Vec3& edge : e) edge = times_power_of_two(edge, -size);
  return e;
}

}  // namespace

TriangleShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::array<Vec3, 3> e = edges_of(a, b, c);
  const double twice_area = length(cross(e[1], e[2]));
  TriangleShape shape;
  for (int k = 0; k < 3; ++k) {
    const double cosine = -dot(e[(k + 1) % 3], e[(k + 2) % 3]);
    shape.angles[k] = kDegrees * std::atan2(twice_area, cosine);
    shape.cotangents[k] =
        twice_area > 0 ? cosine / twice_area : (cosine < 0 ? -kInfinity : kInfinity);
  }
  const std::array<double, 3> l{length(e[0]), length(e[1]), length(e[2])};
  const double half_perimeter = (l[0] + l[1] + l[2]) / 2;
  const double longest = std::max({l[0], l[1], l[2]});
  if (longest > 0)
    shape.quality = 6 / std::sqrt(3.0) * (twice_area / 2) / (half_perimeter * longest);
  return shape;
}

AngleBounds::AngleBounds(double min_angle, double max_angle) {
  constexpr double kRadians = std::numbers::pi / 180;
  constexpr double kMargin = 0x1p-47;  // tens of ulps, above the error of the functions used
  const double c = std::cos(min_angle * kRadians);
  squared_cosine_min_ = min_angle == 0    ? 1
                        : min_angle == 30 ? 0.75
                        : min_angle == 45 ? 0.5
                        : min_angle == 60 ? 0.25
                                          : c * c * (1 - kMargin);
  const double s = std::sin((90 - max_angle) * kRadians);
  squared_cosine_max_ = s * s * (1 + kMargin);
}

bool AngleBounds::below_max(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const auto below = [this](const Vec3& apex, const Vec3& p, const Vec3& q) {
    if (numeric::dot_sign(apex, p, q) <= 0) return false;
    return squared_cosine_max_ == 0 ||
           numeric::compare_squared_cosine(apex, p, q, squared_cosine_max_) > 0;
  };
  return below(a, b, c) && below(b, c, a) && below(c, a, b);
}

bool AngleBounds::above_min(const Vec3& a, const Vec3& b, const Vec3& c) const {
  if (a == b || b == c || c == a) return false;
  const auto above = [this](const Vec3& apex, const Vec3& p, const Vec3& q) {
    const int over = numeric::compare_squared_cosine(apex, p, q, squared_cosine_min_);
    // An angle of exactly 0 is never good enough, and 180 shows as 0 at another corner.
    const bool satisfied = squared_cosine_min_ == 1 ? over < 0 : over <= 0;
    return satisfied || numeric::dot_sign(apex, p, q) <= 0;
  };
  return above(a, b, c) && above(b, c, a) && above(c, a, b);
}

Index count_obtuse(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                   const parallel::Workers& workers) {
  const AngleBounds bounds(0, 90);
  return workers.ordered_sum(triangles.size(), 2048, Index{0},
                             [&](std::size_t begin, std::size_t end) {
                               Index count = 0;
                               for (std::size_t t = begin; t < end; ++t) {
                                 const auto& [a, b, c] = triangles[t];
                                 if (!bounds.below_max(vertices[a], vertices[b], vertices[c]))
                                   ++count;
                               }
                               return count;
                             });
}

namespace {

// Interior vertices: 5 to 7 neighbours; boundary vertices: as the angle of their sector asks for.
double percent_of_good_valence(const TriangleMesh& mesh) {
  const EdgeList edges(mesh.triangles, mesh.vertices.size());
  std::vector<int> valence(mesh.vertices.size(), 0);
  std::vector<char> boundary(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const SharedEdge e = edges[i];
    for (const Index v : {e.low, e.high}) {
      ++valence[v];
      if (e.sides.size() == 1) boundary[v] = 1;
    }
  }
  std::vector<double> sector(mesh.vertices.size(), 0);  // degrees
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (boundary[t[k]] != 0)
        sector[t[k]] += mesh::corner_degrees(mesh.vertices[t[k]], mesh.vertices[t[mesh::next(k)]],
                                             mesh.vertices[t[mesh::previous(k)]]);
  Index used = 0;
  Index good = 0;
  for (std::size_t v = 0; v < valence.size(); ++v) {
    if (valence[v] == 0) continue;
    ++used;
    const mesh::ValenceRange range =
        boundary[v] != 0 ? mesh::sector_valence(sector[v]) : mesh::ValenceRange{};
    if (range.contains(valence[v])) ++good;
  }
  return used > 0 ? 100.0 * good / used : 0;
}

}  // namespace

}  // namespace quality

AngleQuality measure_angles(const TriangleMesh& mesh) {
  quality::require_measurable(mesh);
  const quality::AngleBounds bounds(30, 90);
  AngleQuality result;
  result.triangles = static_cast<Index>(mesh.triangles.size());
  if (result.triangles == 0) return result;
  result.min_angle = 180;
  result.quality_min = 1;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3& a = mesh.vertices[i];
    const Vec3& b = mesh.vertices[j];
    const Vec3& c = mesh.vertices[k];
    const quality::TriangleShape shape = quality::shape_of(a, b, c);
    const auto [smallest, largest] = std::minmax_element(shape.angles.begin(), shape.angles.end());
    result.min_angle = std::min(result.min_angle, *smallest);
    result.max_angle = std::max(result.max_angle, *largest);
    result.mean_min_angle += *smallest;
    result.quality_min = std::min(result.quality_min, shape.quality);
    result.quality_mean += shape.quality;
    if (!bounds.below_max(a, b, c)) ++result.obtuse;
    if (!bounds.above_min(a, b, c)) ++result.small;
  }
  const double count = result.triangles;
  result.mean_min_angle /= count;
  result.quality_mean /= count;
  result.percent_obtuse = 100 * result.obtuse / count;
  result.percent_small = 100 * result.small / count;
  result.percent_valence_567 = quality::percent_of_good_valence(mesh);
  return result;
}

}  // namespace nonobtuse
