// Newton with a Hessian from differences of the gradient and Levenberg's damping (Nocedal & Wright,
// Numerical Optimization, 2006, ch. 10): the hinge makes the energy only once differentiable.
#include "refine/relaxation.h"

#include <algorithm>
#include <array>

#include "refine/neighborhood.h"

namespace nonobtuse::refine {
namespace {

using Matrix = std::array<Vec3, 3>;  // columns

// In units of about an edge length.
constexpr double kDifference = 1e-5;
constexpr double kLongestStep = 0.25;
constexpr double kShortestStep = 1e-9;
constexpr double kKnotSpacing = 0.25;  // least distance of knots along a curve, where the size is 1

// Solves (H + damping) x = b by Cholesky; false if that is not positive definite.
bool solve(const Matrix& h, double damping, const Vec3& b, Vec3& x) {
  const double l00 = h[0].x + damping;
  if (!(l00 > 0)) return false;
  const double l10 = h[0].y / l00, l20 = h[0].z / l00;
  const double d1 = h[1].y + damping - l10 * h[0].y;
  if (!(d1 > 1e-12 * l00)) return false;
  const double e21 = h[1].z - l10 * h[0].z;
  const double l21 = e21 / d1;
  const double d2 = h[2].z + damping - l20 * h[0].z - l21 * e21;
  if (!(d2 > 1e-12 * l00)) return false;
  const double y0 = b.x, y1 = b.y - l10 * y0, y2 = b.z - l20 * y0 - l21 * y1;
  x.z = y2 / d2;
  x.y = y1 / d1 - l21 * x.z;
  x.x = y0 / l00 - l10 * x.y - l20 * x.z;
  return true;
}

Matrix symmetrized(Matrix h) {
  h[0].y = h[1].x = 0.5 * (h[0].y + h[1].x);
  h[0].z = h[2].x = 0.5 * (h[0].z + h[2].x);
  h[1].z = h[2].y = 0.5 * (h[1].z + h[2].y);
  return h;
}

struct RingSolver {
  mesh::EditableMesh& mesh;
  Fidelity& fidelity;
  const RelaxationOptions& options;

  double energy(Index v, const Vec3& p, Vec3* gradient) const {
    return ring_energy(mesh, fidelity, options.shape, v, p, gradient);
  }

  [[nodiscard]] Vec3 tangent(Index v, const Vec3& g) const {
    const Vec3 n = fidelity.vertex_planes[v].normal;
    return g - dot(g, n) * n;
  }

  [[nodiscard]] Matrix hessian(Index v, const Vec3& p, const Vec3& gradient) const {
    Matrix h;
    const double step = kDifference * fidelity.size.at(v);
    const std::array<Vec3, 3> axes{Vec3{step, 0, 0}, Vec3{0, step, 0}, Vec3{0, 0, step}};
    for (int i = 0; i < 3; ++i) {
      Vec3 g;
      energy(v, p + axes[i], &g);
      h[i] = (g - gradient) / step;
    }
    return symmetrized(h);
  }

  // The Hessian in the tangent plane, and stiff along the normal.
  [[nodiscard]] Matrix tangential(Index v, const Matrix& h) const {
    const Vec3 n = fidelity.vertex_planes[v].normal;
    const double stiff = std::abs(h[0].x) + std::abs(h[1].y) + std::abs(h[2].z);
    const Vec3 hn = n.x * h[0] + n.y * h[1] + n.z * h[2];  // H n
    const double nhn = dot(n, hn);
    // (I - nn') H (I - nn') + stiff nn', column by column
    const auto column = [&](const Vec3& c, double ni, double hni) {
      return c - ni * hn - hni * n + ni * (nhn + stiff) * n;
    };
    return {column(h[0], n.x, hn.x), column(h[1], n.y, hn.y), column(h[2], n.z, hn.z)};
  }

  // Energy of all sectors of a knot with its copies at `arc`, and its derivative by the arc.
  double knot_energy(Index knot, double arc, double* slope) const {
    const mesh::Curve& curve = fidelity.knots.curve(knot);
    const Vec3 p = mesh::point_at(curve, arc);
    double sum = 0;
    Vec3 gradient;
    for (Index v : fidelity.knots.all[knot].copies)
      sum += energy(v, p, slope ? &gradient : nullptr);
    if (slope) *slope = dot(gradient, mesh::tangent_at(curve, arc));
    return sum;
  }

  // One damped Newton step along the curve; the energy falls or the knot stays.
  void slide(Index knot) const {
    const SlidingKnot& own = fidelity.knots.all[knot];
    const double arc = own.place.arc;
    const double local = fidelity.size.at(own.copies.front());
    double slope = 0, slope_ahead = 0;
    const double before = knot_energy(knot, arc, &slope);
    if (!std::isfinite(before)) return;
    const double difference = kDifference * local;
    knot_energy(knot, arc + difference, &slope_ahead);
    const double curvature = (slope_ahead - slope) / difference;
    double damping = 1e-6 * std::abs(curvature);
    for (int attempt = 0; attempt < 10;
         ++attempt, damping = std::max(10 * damping, 1e-3 * std::abs(curvature))) {
      if (!(curvature + damping > 0)) continue;
      const double step =
          std::clamp(-slope / (curvature + damping), -kLongestStep * local, kLongestStep * local);
      const double to = arc + fidelity.knots.limited(knot, step, kKnotSpacing * local);
      if (!(std::abs(to - arc) > kShortestStep * local)) return;
      if (knot_energy(knot, to, nullptr) < before) return fidelity.knots.move(mesh, knot, to);
    }
  }

  // Away from a ring with a triangle without area: to the middle of the neighbours.
  void escape(Index v) const {
    Vec3 sum;
    double count = 0;
    for_ring(mesh, v, [&](Index t, int k) {
      sum += mesh.positions[mesh.triangle(t)[mesh::next(k)]];
      count += 1;
    });
    if (std::isfinite(energy(v, sum / count, nullptr))) mesh.positions[v] = sum / count;
  }

  // One damped Newton step; the energy falls or the vertex stays.
  void step(Index v) const {
    const Vec3 p = mesh.positions[v];
    Vec3 g;
    const double before = energy(v, p, &g);
    if (!std::isfinite(before)) return escape(v);
    Matrix h = hessian(v, p, g);
    if (options.on_surface) {
      g = tangent(v, g);
      h = tangential(v, h);
    }
    const double size = std::abs(h[0].x) + std::abs(h[1].y) + std::abs(h[2].z);
    double damping = 1e-6 * size;
    for (int attempt = 0; attempt < 10; ++attempt, damping = std::max(10 * damping, 1e-3 * size)) {
      Vec3 d;
      if (!solve(h, damping, -g, d)) continue;
      if (options.on_surface) d = tangent(v, d);
      const double l = length(d);
      const double local = fidelity.size.at(v);
      if (!(l > kShortestStep * local)) return;
      if (l > kLongestStep * local) d *= kLongestStep * local / l;
      Vec3 to = p + d;
      if (options.on_surface) to = fidelity.walk_foot(to, fidelity.vertex_planes[v].facet).point;
      to = fidelity.on_leash(v, p, to);
      if (energy(v, to, nullptr) < before) {
        mesh.positions[v] = to;
        return;
      }
    }
  }
};

// Calls visit(triangle) around v and all other copies of its knot.
template <class Visit>
void for_rings(const mesh::EditableMesh& mesh, const Knots& knots, Index v, const Visit& visit) {
  const Index knot = knots.empty() ? -1 : mesh.knot[v];
  if (knot < 0) return for_ring(mesh, v, [&](Index t, int) { visit(t); });
  for (Index copy : knots.all[knot].copies) for_ring(mesh, copy, [&](Index t, int) { visit(t); });
}

// Greedy colouring, by index: neighbours get different colours; a knot's first copy stands for all.
std::vector<std::vector<Index>> color_classes(const mesh::EditableMesh& mesh, const Knots& knots,
                                              const std::vector<Index>& vertices) {
  std::vector<std::pair<Index, int>> color;  // by vertex
  color.reserve(vertices.size());
  for (Index v : vertices) color.emplace_back(v, -1);
  std::sort(color.begin(), color.end());
  std::vector<std::vector<Index>> classes;
  for (auto& [v, own] : color) {
    std::uint64_t taken = 0;
    for_rings(mesh, knots, v, [&](Index t) {
      for (Index corner : mesh.triangle(t)) {
        const Index u = knots.representative(mesh, corner);
        const auto it = std::lower_bound(color.begin(), color.end(), std::pair<Index, int>{u, -2});
        if (it != color.end() && it->first == u && it->second >= 0 && it->second < 64)
          taken |= std::uint64_t{1} << it->second;
      }
    });
    own = 0;
    while (own < 63 && (taken >> own & 1)) ++own;
    if (static_cast<int>(classes.size()) <= own) classes.resize(own + 1);
    classes[own].push_back(v);
  }
  return classes;
}

}  // namespace

double ring_energy(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                   const energy::ShapeWeights& shape, Index v, const Vec3& p, Vec3* gradient) {
  double sum = 0;
  for_ring(mesh, v, [&](Index t, int k) {
    std::array<Vec3, 3> c = corners(mesh, t);
    c[k] = p;
    if (gradient) {
      std::array<Vec3, 3> g;
      sum += fidelity.size.shape(mesh.triangle(t), c, shape, g);
      sum += fidelity.triangle(t, c, &g);
      *gradient += g[k];
    } else {
      sum += fidelity.size.shape(mesh.triangle(t), c, shape);
      sum += fidelity.triangle(t, c, nullptr);
    }
  });
  return sum + fidelity.vertex(v, p, gradient);
}

void relax(mesh::EditableMesh& mesh, Fidelity& fidelity, const std::vector<Index>& vertices,
           const RelaxationOptions& options, const parallel::Workers& workers) {
  const Knots& knots = fidelity.knots;
  std::vector<Index> free, slide;
  for (Index v : vertices) {
    const bool on_curve = !knots.empty() && mesh.knot[v] >= 0;
    if (!on_curve && !mesh.on_boundary(v)) free.push_back(v);
    if (knots.sliding(mesh, v) >= 0) slide.push_back(knots.representative(mesh, v));
  }
  sort_unique(slide);
  free.insert(free.end(), slide.begin(), slide.end());
  const RingSolver solver{mesh, fidelity, options};
  const auto classes = color_classes(mesh, knots, free);
  for (int pass = 0; pass < options.passes; ++pass)
    for (const std::vector<Index>& of_one_color : classes)
      workers.for_each(of_one_color.size(), 16, [&](std::size_t i) {
        const Index v = of_one_color[i];
        if (const Index knot = knots.sliding(mesh, v); knot >= 0) {
          solver.slide(knot);
          for (Index copy : knots.all[knot].copies) fidelity.update_vertex(mesh, copy);
          return;
        }
        solver.step(v);
        fidelity.update_vertex(mesh, v);
      });
}

}  // namespace nonobtuse::refine
