// A descent of the CVT energy ends in a glass: it wants all cells of one size, and where limbs
// taper that takes a dislocation for every cell less around the limb. Here the sizes may vary a
// little, the triangles' shape alone decides, and uphill steps let dislocations pass the barriers
// between neighbouring places. Annealing: Kirkpatrick, Gelatt, Vecchi 1983; without exponentials:
// Dueck, Scheuer, Threshold accepting, 1990. For Voronoi sites: Lu et al., Global optimization of
// centroidal Voronoi tessellation with Monte Carlo approach, 2012.
#include "remesh/dislocation_annealing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "numeric/random.h"
#include "refine/angle_goal.h"
#include "refine/fidelity.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {
namespace {

using mesh::Edge;
using mesh::EditableMesh;

constexpr Index kMostVertices = 3000;
// Mean quality that CVT leaves where cells are small against the curvature: .93 and more.
constexpr double kCoarseQuality = 0.92;

constexpr int kSweeps = 20;
constexpr double kTemperature = 0.05;  // at the start, in units of the energy of a triangle
constexpr int kRings = 2;              // that slide with a flip
constexpr int kPassesAround = 3;       // over these
constexpr int kPassesAtFirst = 10;     // over all vertices
constexpr int kPassesBetween = 2;
constexpr double kSizeWeight = 0.05;    // of unequal areas
constexpr double kDistanceWeight = 20;  // of the squared distance of edges, per area
constexpr double kLongestStep = 0.3;    // the ideal edge is 1.07 long
constexpr double kShortestStep = 1e-4;
constexpr double kDifference = 1e-4;
constexpr int kDampings = 6;
constexpr double kLongestDiagonal = 6;  // squared, times the edge that it replaces
constexpr double kLeastCosine = 0.4;    // of new triangles with the old ones
constexpr double kTurnedOver = -0.067;  // cosine of a triangle with the surface
constexpr double kAgainst = 1e4;        // energy of a triangle against the surface
constexpr double kFar = 0.01;           // squared distance of an edge that is looked at twice

// A neighbourhood of a flip, and what it was before.
struct Patch {
  std::vector<Index> vertices, triangles;
  std::vector<Vec3> positions;
  std::vector<Index> feet;
  std::vector<double> distances;
};

class Annealing {
 public:
  Annealing(const mesh::Surface& surface, MeshOnSurface& t)
      : surface_(surface),
        mesh_(t.mesh),
        foot_(t.foot),
        walker_(surface, no_bvh_),
        vertex_mark_(t.mesh.vertex_capacity(), 0),
        triangle_mark_(t.mesh.triangle_capacity(), 0) {}

  void run(std::uint64_t seed, const std::function<bool(double)>& keep_going) {
    slide_all(kPassesAtFirst);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      if (!keep_going(static_cast<double>(sweep) / kSweeps)) return;
      measure_distances();
      numeric::Random random(seed, sweep);
      const double temperature = kTemperature * (1 - sweep / (kSweeps - 1.0));
      for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
        for (int k = 0; k < 3; ++k)
          if (mesh_.adjacent(t, k) > t && may_flip({t, k}))
            try_flip({t, k}, 2 * temperature * random.uniform());
      slide_all(kPassesBetween);
    }
  }

 private:
  // Energy of a triangle (x, y, z): how far it is from equilateral (mean ratio), and its area from
  // the mean. Adds the derivative by x.
  double shape(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& outwards,
               Vec3* gradient) const {
    const Vec3 vector = area_vector(x, y, z);
    const double area = length(vector);  // twice; 1 on the mean
    if (!(area > 1e-9) || dot(vector, outwards) <= kTurnedOver * area) return kAgainst;
    const double edges = squared_distance(x, y) + squared_distance(y, z) + squared_distance(z, x);
    const double scale = 1 / (2 * std::sqrt(3.0) * area);
    if (gradient) {
      const double by_area = kSizeWeight * (1 - 1 / (area * area)) - scale * edges / area;
      *gradient += 2 * scale * ((x - y) + (x - z)) + by_area / area * cross(vector, z - y);
    }
    return scale * edges - 1 + kSizeWeight * (area + 1 / area - 2);
  }

  [[nodiscard]] Vec3 outwards(const Triangle& t) const {
    return normalized(surface_.normals[foot_[t[0]]] + surface_.normals[foot_[t[1]]] +
                      surface_.normals[foot_[t[2]]]);
  }

  [[nodiscard]] double shape(Index t) const {
    const Triangle& v = mesh_.triangle(t);
    const std::vector<Vec3>& x = mesh_.positions;
    return shape(x[v[0]], x[v[1]], x[v[2]], outwards(v), nullptr);
  }

  // Of all triangles at v, if it lay at p.
  double ring_shape(Index v, const Vec3& p, Vec3* gradient) const {
    double sum = 0;
    if (gradient) *gradient = {};
    refine::for_ring(mesh_, v, [&](Index t, int k) {
      const Triangle& c = mesh_.triangle(t);
      sum += shape(p, mesh_.positions[c[mesh::next(k)]], mesh_.positions[c[mesh::previous(k)]],
                   outwards(c), gradient);
    });
    return sum;
  }

  // How far the edges of a triangle are from the surface, in their middles.
  [[nodiscard]] double distance_energy(Index t) const {
    const Triangle& v = mesh_.triangle(t);
    const std::vector<Vec3>& x = mesh_.positions;
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Index a = v[mesh::next(k)], b = v[mesh::previous(k)];
      const Vec3 middle = 0.5 * (x[a] + x[b]);
      double d = squared_distance(walker_.walk_foot(middle, foot_[a]).point, middle);
      if (d > kFar)
        d = std::min(d, squared_distance(walker_.walk_foot(middle, foot_[b]).point, middle));
      sum += d;
    }
    return kDistanceWeight / 8 * length(area_vector(x[v[0]], x[v[1]], x[v[2]])) * sum;
  }

  void measure_distances() {
    distance_.resize(mesh_.triangle_capacity());
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) distance_[t] = distance_energy(t);
  }

  // One damped Newton step in the tangent plane, and back onto the surface; the energy falls or the
  // vertex stays.
  void slide(Index v) {
    const Vec3 p = mesh_.positions[v];
    const Index facet = foot_[v];
    const Vec3 n = surface_.normals[facet];
    const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 s = normalized(axis - dot(axis, n) * n), t = cross(n, s);
    Vec3 g, ahead_s, ahead_t;
    const double before = ring_shape(v, p, &g);
    ring_shape(v, p + kDifference * s, &ahead_s);
    ring_shape(v, p + kDifference * t, &ahead_t);
    const double ss = dot(ahead_s - g, s) / kDifference, tt = dot(ahead_t - g, t) / kDifference;
    const double st = 0.5 * (dot(ahead_s - g, t) + dot(ahead_t - g, s)) / kDifference;
    const double gs = dot(g, s), gt = dot(g, t);
    const double size = std::abs(ss) + std::abs(tt);
    double damping = 1e-3 * size;
    for (int i = 0; i < kDampings; ++i, damping = std::max(10 * damping, 0.01 * size)) {
      const double a = ss + damping, d = tt + damping, determinant = a * d - st * st;
      if (!(a > 0 && determinant > 0)) continue;
      Vec3 step = (-(d * gs - st * gt) / determinant) * s - ((a * gt - st * gs) / determinant) * t;
      const double l = length(step);
      if (!(l > kShortestStep)) return;
      if (l > kLongestStep) step *= kLongestStep / l;
      const refine::TangentPlane plane = walker_.walk_foot(p + step, facet);
      foot_[v] = plane.facet;
      if (ring_shape(v, plane.point, nullptr) < before) {
        mesh_.positions[v] = plane.point;
        return;
      }
      foot_[v] = facet;
    }
  }

  void slide_all(int passes) {
    for (int pass = 0; pass < passes; ++pass)
      for (Index v = 0; v < mesh_.vertex_capacity(); ++v) slide(v);
  }

  // Flips that do not make valences worse, nor fold the mesh.
  [[nodiscard]] bool may_flip(Edge e) const {
    const Edge o = mesh_.twin(e);
    const Index p = mesh_.opposite_vertex(e), q = mesh_.opposite_vertex(o);
    const Index a = mesh_.tail(e), b = mesh_.head(e);
    // Sum of (valence - 6)^2, after less before, halved.
    const int change =
        mesh_.valence(p) + mesh_.valence(q) - mesh_.valence(a) - mesh_.valence(b) + 2;
    if (change > 0 || !mesh_.can_flip(e)) return false;
    const std::vector<Vec3>& x = mesh_.positions;
    if (squared_distance(x[p], x[q]) > kLongestDiagonal * squared_distance(x[a], x[b]))
      return false;
    const Vec3 mean = normalized(area_vector(x[p], x[a], x[b]) + area_vector(x[q], x[b], x[a]));
    return dot(normalized(area_vector(x[p], x[a], x[q])), mean) >= kLeastCosine &&
           dot(normalized(area_vector(x[q], x[b], x[p])), mean) >= kLeastCosine;
  }

  // The vertices of both triangles of an edge and some rings around them, and their triangles.
  void collect_patch(Edge e) {
    const Edge o = mesh_.twin(e);
    ++mark_;
    patch_.vertices = {mesh_.tail(e), mesh_.head(e), mesh_.opposite_vertex(e),
                       mesh_.opposite_vertex(o)};
    patch_.triangles.clear();
    for (const Index v : patch_.vertices) vertex_mark_[v] = mark_;
    std::size_t begin = 0;
    for (int ring = 0; ring <= kRings; ++ring) {
      const std::size_t end = patch_.vertices.size();
      for (; begin < end; ++begin)
        refine::for_ring(mesh_, patch_.vertices[begin], [&](Index t, int) {
          if (triangle_mark_[t] == mark_) return;
          triangle_mark_[t] = mark_;
          patch_.triangles.push_back(t);
          if (ring == kRings) return;
          for (const Index u : mesh_.triangle(t)) {
            if (vertex_mark_[u] == mark_) continue;
            vertex_mark_[u] = mark_;
            patch_.vertices.push_back(u);
          }
        });
    }
    patch_.positions.clear();
    patch_.feet.clear();
    patch_.distances.clear();
    for (const Index v : patch_.vertices) {
      patch_.positions.push_back(mesh_.positions[v]);
      patch_.feet.push_back(foot_[v]);
    }
    for (const Index t : patch_.triangles) patch_.distances.push_back(distance_[t]);
  }

  double patch_energy() const {
    double sum = 0;
    for (const Index t : patch_.triangles) sum += shape(t) + distance_[t];
    return sum;
  }

  void try_flip(Edge e, double allowed) {
    collect_patch(e);
    const double before = patch_energy();
    const Edge flipped = mesh_.flip(e);
    for (int pass = 0; pass < kPassesAround; ++pass)
      for (const Index v : patch_.vertices) slide(v);
    for (const Index t : patch_.triangles) distance_[t] = distance_energy(t);
    if (patch_energy() <= before + allowed) return;
    const Edge back = mesh_.flip(flipped);
    for (std::size_t i = 0; i < patch_.vertices.size(); ++i) {
      mesh_.positions[patch_.vertices[i]] = patch_.positions[i];
      foot_[patch_.vertices[i]] = patch_.feet[i];
    }
    for (std::size_t i = 0; i < patch_.triangles.size(); ++i)
      distance_[patch_.triangles[i]] = patch_.distances[i];
    // These two may have changed places.
    for (const Index t : {back.triangle, mesh_.twin(back).triangle})
      distance_[t] = distance_energy(t);
  }

  const mesh::Surface& surface_;
  EditableMesh& mesh_;
  std::vector<Index>& foot_;
  spatial::TriangleBvh no_bvh_;  // feet are found by walking alone
  refine::Fidelity walker_;
  std::vector<double> distance_;  // #T, of the mesh as it is
  Patch patch_;
  std::vector<int> vertex_mark_, triangle_mark_;
  int mark_ = 0;
};

}  // namespace

bool is_coarse(const mesh::Surface& surface, const MeshOnSurface& tessellation) {
  const EditableMesh& mesh = tessellation.mesh;
  if (!surface.size.empty() || mesh.vertex_count() > kMostVertices) return false;
  if (mesh.vertex_capacity() != mesh.vertex_count() ||
      mesh.triangle_capacity() != mesh.triangle_count())
    return false;
  for (const Index f : tessellation.foot)
    if (f < 0) return false;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.on_boundary(v)) return false;
  return refine::mean_quality(mesh) < kCoarseQuality;
}

void anneal_dislocations(const mesh::Surface& surface, MeshOnSurface& tessellation,
                         std::uint64_t seed, const std::function<bool(double)>& keep_going) {
  Annealing(surface, tessellation).run(seed, keep_going);
}

}  // namespace nonobtuse::pipeline
