// Energy: Du, Faber, Gunzburger 1999, integrated piece by piece (energy/mesh_shape.h). Where edges
// are Delaunay every term is positive; the hinge and the flips keep it so.
#include "remesh/mesh_tessellation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "energy/mesh_shape.h"
#include "optimize/lbfgs.h"
#include "rdt/delaunay_flips.h"
#include "refine/fidelity.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {
namespace {

using mesh::EditableMesh;

constexpr std::size_t kChunk = 512;
constexpr double kLongestStep = 0.3;  // times the root of the mean area of a cell
constexpr int kHalvings = 4;
constexpr int kFlipSweeps = 3;
// Bounds of the hinge, wide of what a Delaunay mesh of even spacing has.
constexpr double kHinge = 3;
constexpr double kSmallest = 20;
constexpr double kLargest = 100;
constexpr int kStepsBetweenDensities = 10;
constexpr double kMostDensity = 4;
constexpr double kNearEdge = 0.04;  // squared, times half the edge
constexpr int kStepsBetweenValences = 10;
constexpr int kStepsOfRelaxation = 3;
constexpr int kRoundsOfUnfolding = 10;
constexpr double kLongestDiagonal = 4;  // squared, times the edge that it replaces

// The surface's point over the middle of the edge ab, as seen from the nearer end.
Vec3 over_middle(const refine::Fidelity& walker, const EditableMesh& mesh,
                 const std::vector<Index>& foot, Index a, Index b) {
  const Vec3 middle = 0.5 * (mesh.positions[a] + mesh.positions[b]);
  const Vec3 p = walker.walk_foot(middle, foot[a]).point;
  // Near the edge there is nothing that a walk from the other end could find.
  if (squared_distance(p, middle) < kNearEdge * squared_distance(mesh.positions[a], middle))
    return p;
  const Vec3 q = walker.walk_foot(middle, foot[b]).point;
  return squared_distance(p, middle) <= squared_distance(q, middle) ? p : q;
}

// Per vertex, how much more area the triangles around it have once the middles of their edges lie
// on the surface, at least 1.
std::vector<double> area_ratios(const mesh::Surface& surface, const EditableMesh& mesh,
                                const std::vector<Index>& foot, const parallel::Workers& workers) {
  const spatial::TriangleBvh none;
  const refine::Fidelity walker(surface, none);
  std::vector<std::array<Vec3, 3>> over(mesh.triangle_capacity());
  workers.for_each(over.size(), kChunk, [&](std::size_t i) {
    const auto t = static_cast<Index>(i);
    for (int k = 0; k < 3; ++k) {
      const mesh::Edge e{t, k};
      if (mesh.adjacent(t, k) < t) continue;
      const mesh::Edge o = mesh.twin(e);
      over[t][k] = over[o.triangle][o.corner] =
          over_middle(walker, mesh, foot, mesh.tail(e), mesh.head(e));
    }
  });
  std::vector<double> flat(mesh.vertex_capacity(), 0), bent(mesh.vertex_capacity(), 0);
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    const Triangle& v = mesh.triangle(t);
    const std::array<Vec3, 3> p{mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
    const std::array<Vec3, 3>& m = over[t];
    const double one = length(area_vector(p[0], p[1], p[2]));
    const double four =
        length(area_vector(p[0], m[2], m[1])) + length(area_vector(p[1], m[0], m[2])) +
        length(area_vector(p[2], m[1], m[0])) + length(area_vector(m[0], m[1], m[2]));
    for (const Index i : v) flat[i] += one, bent[i] += four;
  }
  for (std::size_t v = 0; v < flat.size(); ++v) bent[v] = std::max(1.0, bent[v] / flat[v]);
  return bent;
}

class MeshDescent {
 public:
  MeshDescent(const mesh::Surface& surface, MeshOnSurface& t, const MeshDescentOptions& options,
              const parallel::Workers& workers)
      : surface_(surface),
        mesh_(t.mesh),
        foot_(t.foot),
        options_(options),
        workers_(workers),
        walker_(surface, no_bvh_),
        area_(surface.area / t.mesh.vertex_count()),
        weights_(energy::hinged(kHinge, kSmallest, kLargest)) {
    weights_.cvt = 1 / area_;
    weights_.circumcentre = options.circumcentre;
  }

  void run(const std::function<bool()>& keep_going) {
    int density_at = 0, valences_at = kStepsBetweenValences;
    for (int done = 0; done < options_.steps && keep_going();) {
      if (done >= valences_at) {
        valences_at += kStepsBetweenValences;
        done += mend_valences();
      }
      rdt::delaunay_flips(surface_, foot_, mesh_, kFlipSweeps);
      if (done >= density_at) {
        density_at += kStepsBetweenDensities;
        measure_density();
      }
      const int steps = std::min(options_.steps_between_flips, options_.steps - done);
      if (steps > 0) descend(steps);
      done += steps;
    }
    rdt::delaunay_flips(surface_, foot_, mesh_, kFlipSweeps);
  }

 private:
  [[nodiscard]] std::array<Vec3, 3> corners(Index t) const {
    const Triangle& v = mesh_.triangle(t);
    return {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
  }

  // Tangent planes and stiffness at all vertices; from each vertex to its triangles.
  void freeze() {
    const Index vertices = mesh_.vertex_capacity(), triangles = mesh_.triangle_capacity();
    corner_start_.assign(vertices + 1, 0);
    for (const Triangle& v : mesh_.triangles())
      for (const Index i : v) ++corner_start_[i + 1];
    for (Index v = 0; v < vertices; ++v) corner_start_[v + 1] += corner_start_[v];
    corner_.resize(3 * triangles);
    std::vector<Index> fill(corner_start_.begin(), corner_start_.end() - 1);
    for (Index t = 0; t < triangles; ++t)
      for (int k = 0; k < 3; ++k) corner_[fill[mesh_.triangle(t)[k]]++] = 3 * t + k;
    gradient_of_corner_.resize(triangles);
    normal_.resize(vertices);
    inverse_stiffness_.resize(vertices);
    workers_.for_each(vertices, kChunk, [&](std::size_t v) {
      Vec3 normal;
      double ring = 0;
      for (Index c = corner_start_[v]; c < corner_start_[v + 1]; ++c) {
        const std::array<Vec3, 3> p = corners(corner_[c] / 3);
        const Vec3 twice = area_vector(p[0], p[1], p[2]);
        normal += twice;
        ring += length(twice);
      }
      normal_[v] = normalized(normal);
      // Lloyd's 2 m, and about 4 for each triangle in the circumcentre term.
      const double valence = corner_start_[v + 1] - corner_start_[v];
      inverse_stiffness_[v] =
          1 / (weights_.cvt * density_[v] * ring / 3 + weights_.circumcentre * 4 * valence);
    });
  }

  double evaluate(std::vector<Vec3>& gradient) {
    const double energy = workers_.ordered_sum(
        gradient_of_corner_.size(), kChunk, 0.0, [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          energy::ShapeWeights weights = weights_;
          for (std::size_t t = begin; t < end; ++t) {
            const Triangle& v = mesh_.triangle(static_cast<Index>(t));
            weights.cvt = weights_.cvt * (density_[v[0]] + density_[v[1]] + density_[v[2]]) / 3;
            sum += energy::triangle_shape(mesh_.positions[v[0]], mesh_.positions[v[1]],
                                          mesh_.positions[v[2]], weights, gradient_of_corner_[t]);
          }
          return sum;
        });
    gradient.resize(mesh_.positions.size());
    workers_.for_each(gradient.size(), kChunk, [&](std::size_t v) {
      Vec3 g;
      for (Index c = corner_start_[v]; c < corner_start_[v + 1]; ++c)
        g += gradient_of_corner_[corner_[c] / 3][corner_[c] % 3];
      gradient[v] = g - dot(g, normal_[v]) * normal_[v];
    });
    return energy;
  }

  bool search_line(double energy, double slope, double step, double& reached) {
    for (int i = 0; i <= kHalvings; ++i, step *= 0.5) {
      workers_.for_each(direction_.size(), kChunk, [&](std::size_t v) {
        mesh_.positions[v] = origin_[v] + step * direction_[v];
      });
      reached = evaluate(trial_gradient_);
      if (reached <= energy + 1e-4 * step * slope) return true;
    }
    mesh_.positions = origin_;
    return false;
  }

  void find_direction() {
    direction_.resize(gradient_.size());
    history_.direction(
        gradient_, direction_,
        [&](std::span<const Vec3> in, std::span<Vec3> out) {
          workers_.for_each(in.size(), 4 * kChunk,
                            [&](std::size_t v) { out[v] = inverse_stiffness_[v] * in[v]; });
        },
        workers_);
    const double longest = kLongestStep * std::sqrt(area_);
    workers_.for_each(direction_.size(), kChunk, [&](std::size_t v) {
      direction_[v] -= dot(direction_[v], normal_[v]) * normal_[v];
      const double l = length(direction_[v]);
      if (l > longest) direction_[v] *= longest / l;
    });
  }

  // Steps with fixed connectivity and tangent planes, then back onto the surface.
  void descend(int steps) {
    freeze();
    double energy = evaluate(gradient_);
    for (int i = 0; i < steps; ++i) {
      find_direction();
      origin_ = mesh_.positions;
      const double slope = optimize::dot(direction_, gradient_, workers_);
      const bool fresh = history_.size() == 0;
      double reached = 0;
      if (!(slope < 0) || !search_line(energy, slope, fresh ? 0.7 : 1.0, reached)) {
        history_.clear();
        if (fresh) break;
        continue;
      }
      energy = reached;
      workers_.for_each(direction_.size(), kChunk, [&](std::size_t v) {
        direction_[v] = mesh_.positions[v] - origin_[v];
        gradient_[v] = trial_gradient_[v] - gradient_[v];
      });
      history_.add(direction_, gradient_, workers_);
      std::swap(gradient_, trial_gradient_);
    }
    workers_.for_each(foot_.size(), kChunk, [&](std::size_t v) {
      const refine::TangentPlane plane = walker_.walk_foot(mesh_.positions[v], foot_[v]);
      mesh_.positions[v] = plane.point;
      foot_[v] = plane.facet;
    });
  }

  // By flips that bring valences nearer to six, whatever they cost; a few steps with stiff
  // triangles then decide whether they last. Returns the number of steps.
  int mend_valences() {
    if (flip_for_valence() == 0) return 0;
    const energy::ShapeWeights weights = weights_;
    weights_.circumcentre = 1;
    history_.clear();
    descend(kStepsOfRelaxation);
    history_.clear();
    weights_ = weights;
    return kStepsOfRelaxation;
  }

  Index flip_for_valence() {
    Index flips = 0;
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
      for (int k = 0; k < 3; ++k)
        if (mesh_.adjacent(t, k) > t && mends_valence({t, k})) {
          mesh_.flip({t, k});
          ++flips;
          break;
        }
    return flips;
  }

  [[nodiscard]] bool mends_valence(mesh::Edge e) const {
    const mesh::Edge o = mesh_.twin(e);
    const Index p = mesh_.opposite_vertex(e), q = mesh_.opposite_vertex(o);
    const Index a = mesh_.tail(e), b = mesh_.head(e);
    // Sum of (valence - 6)^2, after less before, halved.
    const int change =
        mesh_.valence(p) + mesh_.valence(q) - mesh_.valence(a) - mesh_.valence(b) + 2;
    if (change >= 0 || !mesh_.can_flip(e)) return false;
    const std::vector<Vec3>& x = mesh_.positions;
    if (squared_distance(x[p], x[q]) > kLongestDiagonal * squared_distance(x[a], x[b]))
      return false;
    const Vec3 mean = normalized(area_vector(x[p], x[a], x[b]) + area_vector(x[q], x[b], x[a]));
    return dot(normalized(area_vector(x[p], x[a], x[q])), mean) >= 0.5 &&
           dot(normalized(area_vector(x[q], x[b], x[p])), mean) >= 0.5;
  }

  // Sites are wanted by the surface's area, not the mesh's, which cuts off tips and fingers: the
  // density for that is the square of the ratio.
  void measure_density() {
    density_ = area_ratios(surface_, mesh_, foot_, workers_);
    for (double& d : density_) d = std::min(d * d, kMostDensity);
  }

  const mesh::Surface& surface_;
  EditableMesh& mesh_;
  std::vector<Index>& foot_;
  MeshDescentOptions options_;
  const parallel::Workers& workers_;
  spatial::TriangleBvh no_bvh_;  // feet are found by walking alone
  refine::Fidelity walker_;
  double area_;  // of the mean cell
  energy::ShapeWeights weights_;
  optimize::LbfgsHistory history_{7};
  std::vector<Index> corner_start_, corner_;  // vertex -> 3 t + k
  std::vector<std::array<Vec3, 3>> gradient_of_corner_;
  std::vector<Vec3> normal_, gradient_, trial_gradient_, direction_, origin_;
  std::vector<double> inverse_stiffness_, density_;
};

}  // namespace

void minimize_on_mesh(const mesh::Surface& surface, MeshOnSurface& tessellation,
                      const MeshDescentOptions& options, const parallel::Workers& workers,
                      const std::function<bool()>& keep_going) {
  MeshDescent(surface, tessellation, options, workers).run(keep_going);
}

namespace {

std::vector<Index> folded_triangles(const mesh::Surface& surface, const MeshOnSurface& t) {
  std::vector<Index> folded;
  const std::vector<Vec3>& x = t.mesh.positions;
  for (Index i = 0; i < t.mesh.triangle_capacity(); ++i) {
    const Triangle& v = t.mesh.triangle(i);
    if (dot(area_vector(x[v[0]], x[v[1]], x[v[2]]), rdt::reference_normal(surface, t.foot, v)) <= 0)
      folded.push_back(i);
  }
  return folded;
}

// The corners of these triangles and all their neighbours, by index.
std::vector<Index> vertices_around(const EditableMesh& mesh, const std::vector<Index>& triangles) {
  std::vector<Index> around, ring;
  for (const Index t : triangles)
    for (const Index v : mesh.triangle(t)) {
      mesh.neighbors(v, ring);
      around.insert(around.end(), ring.begin(), ring.end());
    }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

}  // namespace

double largest_area_ratio(const mesh::Surface& surface, const MeshOnSurface& tessellation,
                          const parallel::Workers& workers) {
  const std::vector<double> ratio =
      area_ratios(surface, tessellation.mesh, tessellation.foot, workers);
  return ratio.empty() ? 1 : *std::max_element(ratio.begin(), ratio.end());
}

Index unfold(const mesh::Surface& surface, MeshOnSurface& tessellation) {
  const spatial::TriangleBvh none;
  const refine::Fidelity walker(surface, none);
  EditableMesh& mesh = tessellation.mesh;
  std::vector<Index> folded = folded_triangles(surface, tessellation), ring;
  for (int round = 0; round < kRoundsOfUnfolding && !folded.empty(); ++round) {
    for (const Index v : vertices_around(mesh, folded)) {
      mesh.neighbors(v, ring);
      Vec3 sum;
      for (const Index u : ring) sum += mesh.positions[u];
      const refine::TangentPlane plane =
          walker.walk_foot(sum / static_cast<double>(ring.size()), tessellation.foot[v]);
      mesh.positions[v] = plane.point;
      tessellation.foot[v] = plane.facet;
    }
    rdt::delaunay_flips(surface, tessellation.foot, mesh, kFlipSweeps);
    folded = folded_triangles(surface, tessellation);
  }
  return static_cast<Index>(folded.size());
}

}  // namespace nonobtuse::pipeline
