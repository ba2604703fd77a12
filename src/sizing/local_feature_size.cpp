// Poles without a Voronoi diagram: the two balls that touch the surface at a sample, one on each
// side, shrunk until they hold no other sample (Ma, Bae, Choi, 3D medial axis point approximation
// using nearest neighbors and the normal field, 2012). With the density of the samples the centres
// converge to the poles of Amenta & Bern 1999, the farthest vertices of the sample's Voronoi cell
// on either side. From evenly spread samples, never from the vertices of the input: those follow
// the input's triangles.
#include "sizing/local_feature_size.h"

#include <array>
#include <cmath>
#include <limits>

#include "numeric/random.h"
#include "rvd/facet_pieces.h"
#include "spatial/box.h"
#include "spatial/closest_point.h"
#include "spatial/kd_tree.h"

namespace nonobtuse::sizing {
namespace {

constexpr int kMostShrinks = 40;
// A ball whose two contacts are seen from its centre under a smaller angle (30 degrees) touches the
// surface at one place only: what shrank it is the noise of facets and normals.
constexpr double kCosSeparation = 0.866;

struct Samples {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
};

std::vector<Vec3> vertex_normals(const mesh::Surface& surface) {
  std::vector<Vec3> normals(surface.vertices.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (const Index v : surface.triangles[f]) normals[v] += surface.areas[f] * surface.normals[f];
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

// One sample in each of `count` strata of equal area along a space-filling curve, with normals
// interpolated from the vertices.
Samples spread(const mesh::Surface& surface, Index count) {
  const std::vector<Vec3> normals = vertex_normals(surface);
  mesh::Surface plain = surface;
  plain.size.clear();
  const rvd::FacetPieces pieces = rvd::facet_pieces(plain, count);
  Samples samples;
  double passed = 0;
  for (Index p = 0; p < pieces.count(); ++p) {
    passed += pieces.area[p];
    while (static_cast<Index>(samples.points.size()) < count &&
           (static_cast<double>(samples.points.size()) + 0.5) * surface.area <= passed * count) {
      numeric::Random random(0x1f5, samples.points.size());
      double a = random.uniform(), b = random.uniform();
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const std::array<Vec3, 3> c = pieces.corners_of(p);
      const Vec3 at = (1 - a - b) * c[0] + a * c[1] + b * c[2];
      const Triangle& t = surface.triangles[pieces.facet[p]];
      const auto closest = spatial::closest_point_on_triangle(
          at, surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
      const Vec3 w = closest.barycentric;
      samples.points.push_back(at);
      samples.normals.push_back(
          normalized(w.x * normals[t[0]] + w.y * normals[t[1]] + w.z * normals[t[2]]));
    }
  }
  return samples;
}

// Shrinks the ball that touches p on the side of `normal` so that q is not inside. False if it was
// not, or if the two contacts are too close together to mean anything.
bool shrink_to(const Vec3& p, const Vec3& normal, const Vec3& q, double& radius) {
  const double height = dot(normal, q - p);
  if (!(height > 0)) return false;
  const double smaller = squared_distance(p, q) / (2 * height);
  if (!(smaller < radius * (1 - 1e-9))) return false;
  const Vec3 center = p + smaller * normal;
  if (dot(p - center, q - center) > kCosSeparation * smaller * smaller) return false;
  radius = smaller;
  return true;
}

// The empty ball that touches sample `i` on the side of `normal`; false if it stays unbounded.
// `contact` is the other sample it touches; that of a nearby ball, or -1, on entry.
bool shrink(const Samples& samples, const spatial::NearestSites& tree, std::size_t i,
            const Vec3& normal, double largest, Index& contact, Vec3& center) {
  const Vec3 p = samples.points[i];
  std::vector<spatial::NearestSites::Neighbor> near;
  double radius = largest;
  // A first bound that spares searching around centres far from the surface.
  bool bounded = contact >= 0 && shrink_to(p, normal, samples.points[contact], radius);
  if (!bounded) contact = -1;
  for (int step = 0; step < kMostShrinks; ++step) {
    tree.nearest(p + radius * normal, 2, near);
    if (near.empty()) break;
    const auto& other =
        near[0].site == static_cast<Index>(i) && near.size() > 1 ? near[1] : near[0];
    if (other.site == static_cast<Index>(i)) break;
    if (other.squared_distance >= radius * radius * (1 - 1e-9)) break;
    if (!shrink_to(p, normal, samples.points[other.site], radius)) break;
    contact = other.site;
    bounded = true;
  }
  center = p + radius * normal;
  return bounded;
}

}  // namespace

std::vector<Vec3> medial_points(const mesh::Surface& surface, Index samples,
                                const parallel::Workers& workers) {
  const Samples spread_samples = spread(surface, samples);
  const std::size_t count = spread_samples.points.size();
  spatial::Box box;
  for (const Vec3& v : surface.vertices) box.add(v);
  const double largest = distance(box.low, box.high);
  const spatial::NearestSites tree(spread_samples.points);
  std::vector<Vec3> centers(2 * count);
  std::vector<char> bounded(2 * count, 0);
  workers.for_chunks(count, 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    Index outside = -1, inside = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 n = spread_samples.normals[i];
      if (squared_length(n) == 0) continue;
      bounded[2 * i] = shrink(spread_samples, tree, i, n, largest, outside, centers[2 * i]);
      bounded[2 * i + 1] = shrink(spread_samples, tree, i, -n, largest, inside, centers[2 * i + 1]);
    }
  });
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < centers.size(); ++k)
    if (bounded[k]) points.push_back(centers[k]);
  return points;
}

std::vector<double> local_feature_size(const mesh::Surface& surface, Index samples,
                                       const parallel::Workers& workers) {
  std::vector<double> lfs(surface.vertices.size(), std::numeric_limits<double>::infinity());
  const std::vector<Vec3> axis = medial_points(surface, samples, workers);
  if (axis.empty()) return lfs;
  const spatial::NearestSites tree(axis);
  workers.for_each(lfs.size(), 256, [&](std::size_t v) {
    lfs[v] = std::sqrt(tree.nearest(surface.vertices[v]).squared_distance);
  });
  return lfs;
}

}  // namespace nonobtuse::sizing
