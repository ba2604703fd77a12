// Cignoni, Rocchini, Scopigno, Metro: Measuring Error on Simplified Surfaces, 1998, with samples
// placed by the R2 sequence (Roberts 2018) from a random start in every triangle.
#include "quality/distance.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nonobtuse/error.h"
#include "nonobtuse/quality.h"
#include "numeric/random.h"
#include "numeric/vec3.h"
#include "quality/validity.h"

namespace nonobtuse {

namespace quality {

namespace {

constexpr std::uint64_t kSampleSeed = 0x6d6574726f;  // of the samples' streams; arbitrary
constexpr std::size_t kChunk = 256;

double area_of(const TriangleMesh& mesh, Index t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * length(area_vector(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
}

// Calls visit(point) for `count` points spread evenly over triangle t.
template <class Visit>
void sample_triangle(const TriangleMesh& mesh, Index t, std::size_t count, const Visit& visit) {
  const auto& [i, j, k] = mesh.triangles[t];
  const Vec3& a = mesh.vertices[i];
  const Vec3& b = mesh.vertices[j];
  const Vec3& c = mesh.vertices[k];
  numeric::Random random(kSampleSeed, static_cast<std::uint64_t>(t));
  double u = random.uniform();
  double v = random.uniform();
  for (std::size_t s = 0; s < count; ++s) {
    // Folding the square over its diagonal keeps the points' evenness.
    const bool folded = u + v > 1;
    visit(a + (folded ? 1 - u : u) * (b - a) + (folded ? 1 - v : v) * (c - a));
    u += 0.75487766624669276;  // 1 / plastic number, and its square
    v += 0.56984029099805327;
    if (u >= 1) u -= 1;
    if (v >= 1) v -= 1;
  }
}

// Squared distances of points that follow each other in space: the last one bounds the next.
class Follower {
 public:
  explicit Follower(const spatial::TriangleBvh& target) : target_(target) {}

  double squared_distance(const Vec3& p) {
    double limit = std::numeric_limits<double>::infinity();
    if (started_) {
      // The last nearest point is at most as far as this; enlarged for rounding.
      const double reach = nonobtuse::distance(p, last_nearest_);
      limit = reach * reach * (1 + 1e-12) + 1e-300;
    }
    const auto hit = target_.closest(p, limit);
    if (hit.triangle < 0) return limit;
    started_ = true;
    last_nearest_ = hit.point;
    last_triangle_ = hit.triangle;
    return hit.squared_distance;
  }

  /// The triangle of the last point found, or one about as near; -1 before.
  [[nodiscard]] Index last_triangle() const { return last_triangle_; }

 private:
  const spatial::TriangleBvh& target_;
  bool started_ = false;
  Vec3 last_nearest_;
  Index last_triangle_ = -1;
};

struct Part {
  double max = 0;
  double sum = 0;
  double count = 0;

  void add(double squared, bool counts) {
    max = std::max(max, squared);
    if (!counts) return;
    sum += squared;
    count += 1;
  }
  Part& operator+=(const Part& other) {
    max = std::max(max, other.max);
    sum += other.sum;
    count += other.count;
    return *this;
  }
};

}  // namespace

std::size_t default_samples(const TriangleMesh& a, const TriangleMesh& b) {
  return std::max<std::size_t>(200'000, 10 * std::max(a.vertices.size(), b.vertices.size()));
}

OneSidedDistance one_sided_distance(const TriangleMesh& mesh, std::span<const Index> order,
                                    const spatial::TriangleBvh& target, std::size_t samples,
                                    const parallel::Workers& workers,
                                    std::vector<TriangleDistance>* by_triangle) {
  if (by_triangle != nullptr) by_triangle->assign(mesh.triangles.size(), {});
  // Area up to each triangle in `order`: sample s lies at (s + 1/2) / samples of the whole.
  std::vector<double> upto(order.size() + 1, 0);
  for (std::size_t i = 0; i < order.size(); ++i) upto[i + 1] = upto[i] + area_of(mesh, order[i]);
  const double area = upto.back();
  const auto samples_before = [&](std::size_t i) {
    if (!(area > 0)) return std::size_t{0};
    return static_cast<std::size_t>(upto[i] / area * static_cast<double>(samples) + 0.5);
  };
  // Each used vertex once, with the first triangle that has it.
  std::vector<Index> first_use(mesh.vertices.size(), -1);
  for (const Index t : order)
    for (const Index v : mesh.triangles[t])
      if (first_use[v] < 0) first_use[v] = t;

  const Part part =
      workers.ordered_sum(order.size(), kChunk, Part{}, [&](std::size_t begin, std::size_t end) {
        Part sum;
        Follower follower(target);
        for (std::size_t i = begin; i < end; ++i) {
          TriangleDistance worst;  // squared at first
          const auto visit = [&](const Vec3& p, bool counts) {
            const double squared = follower.squared_distance(p);
            sum.add(squared, counts);
            if (worst.nearest < 0 || squared > worst.distance)
              worst = {squared, follower.last_triangle()};
          };
          for (const Index v : mesh.triangles[order[i]])
            if (first_use[v] == order[i]) visit(mesh.vertices[v], false);
          sample_triangle(mesh, order[i], samples_before(i + 1) - samples_before(i),
                          [&](const Vec3& p) { visit(p, true); });
          if (by_triangle != nullptr)
            (*by_triangle)[order[i]] = {std::sqrt(worst.distance), worst.nearest};
        }
        return sum;
      });
  return {std::sqrt(part.max), part.count > 0 ? std::sqrt(part.sum / part.count) : 0};
}

Index count_flipped(const TriangleMesh& mesh, const TriangleMesh& reference,
                    const spatial::TriangleBvh& reference_bvh, const parallel::Workers& workers) {
  const auto normal = [](const TriangleMesh& m, std::size_t t) {
    const auto& [a, b, c] = m.triangles[t];
    return area_vector(m.vertices[a], m.vertices[b], m.vertices[c]);
  };
  std::vector<Vec3> vertex_normals(reference.vertices.size());
  for (std::size_t t = 0; t < reference.triangles.size(); ++t)
    for (const Index v : reference.triangles[t]) vertex_normals[v] += normal(reference, t);
  return workers.ordered_sum(
      mesh.triangles.size(), kChunk, Index{0}, [&](std::size_t begin, std::size_t end) {
        Index count = 0;
        for (std::size_t t = begin; t < end; ++t) {
          const auto& [a, b, c] = mesh.triangles[t];
          const Vec3 centroid = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
          const auto hit = reference_bvh.closest(centroid);
          const auto& [i, j, k] = reference.triangles[hit.triangle];
          const Vec3 around = hit.barycentric.x * vertex_normals[i] +
                              hit.barycentric.y * vertex_normals[j] +
                              hit.barycentric.z * vertex_normals[k];
          const Vec3 own = normal(mesh, t);
          if (dot(own, normal(reference, hit.triangle)) < 0 && dot(own, around) < 0) ++count;
        }
        return count;
      });
}

}  // namespace quality

}  // namespace nonobtuse
