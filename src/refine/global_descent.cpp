// Preconditioner: per vertex a tangential and a normal stiffness, estimated triangle by triangle
// from the second derivatives of the terms at a good triangle; frozen between calls of `freeze`.
#include "refine/global_descent.h"

#include <algorithm>

namespace nonobtuse::refine {
namespace {

constexpr std::size_t kChunk = 512;
constexpr double kLongestStep = 0.3;  // of a vertex of size 1, where the ideal edge is 1.07 long
constexpr int kHalvings = 6;
// Shape energy from which a triangle beside curves counts as collapsed: at an angle of a quarter of
// a degree. A good one has about one.
constexpr double kCollapsed = 1e4;
constexpr double kKnotSpacing = 0.25;  // least distance of knots along a curve, where the size is 1

// Tangential stiffness of a triangle's shape energy.
double shape_stiffness(const std::array<Vec3, 3>& p, const energy::ShapeWeights& w) {
  const std::array<double, 3> s = energy::squared_edges(p[0], p[1], p[2]);
  const double area = 0.5 * length(area_vector(p));
  const double perimeter = std::sqrt(s[0]) + std::sqrt(s[1]) + std::sqrt(s[2]);
  // R / 2r = abc perimeter / (16 area^2)
  const double ratio = std::sqrt(s[0] * s[1] * s[2]) * perimeter / (16 * area * area + 1e-12);
  double stiffness = w.cvt * 2 * area / 3 + w.circumcentre * 2 * std::min(20.0, 1 + ratio);
  const double longest = std::max(s[0], std::max(s[1], s[2]));
  for (int k = 0; k < 3; ++k) {
    const double b = s[mesh::next(k)], c = s[mesh::previous(k)];
    const double cosine = (b + c - s[k]) / (2 * std::sqrt(b * c));
    if (cosine < w.cos_largest || cosine > w.cos_smallest) stiffness += w.hinge * 4 / longest;
  }
  return stiffness;
}

}  // namespace

GlobalDescent::GlobalDescent(mesh::EditableMesh& mesh, Fidelity& fidelity, bool on_surface,
                             const parallel::Workers& workers)
    : mesh_(mesh), fidelity_(fidelity), on_surface_(on_surface), workers_(workers) {}

void GlobalDescent::freeze() {
  const Index vertices = mesh_.vertex_capacity(), triangles = mesh_.triangle_capacity();
  corner_start_.assign(vertices + 1, 0);
  for (const Triangle& v : mesh_.triangles())
    for (Index i : v) ++corner_start_[i + 1];
  for (Index v = 0; v < vertices; ++v) corner_start_[v + 1] += corner_start_[v];
  corner_.resize(3 * triangles);
  std::vector<Index> fill(corner_start_.begin(), corner_start_.end() - 1);
  for (Index t = 0; t < triangles; ++t)
    for (int k = 0; k < 3; ++k) corner_[fill[mesh_.triangle(t)[k]]++] = 3 * t + k;
  fixed_.resize(vertices);
  const bool knots = !fidelity_.knots.empty();
  collapsed_.assign(triangles, 0);
  for (Index v = 0; v < vertices; ++v)
    fixed_[v] = mesh_.on_boundary(v) || (knots && mesh_.knot[v] >= 0);

  // corner_gradient_ serves as scratch: x holds the shape's stiffness, y the samples'.
  corner_gradient_.resize(triangles);
  workers_.for_each(triangles, kChunk, [&](std::size_t i) {
    const Index t = static_cast<Index>(i);
    const std::array<Vec3, 3> p = corners(mesh_, t);
    const double area = fidelity_.size.area(mesh_.triangle(t));
    const double unit = std::sqrt(area);
    collapsed_[t] = knots && !(fidelity_.size.shape(mesh_.triangle(t), p, shape) < kCollapsed);
    const double stiffness =
        fidelity_.size.uniform()
            ? shape_stiffness(p, shape)
            : shape_stiffness({p[0] / unit, p[1] / unit, p[2] / unit}, shape) / area;
    std::array<double, 3> pull{0, 0, 0};
    const TriangleFrame frame(p[0], p[1], p[2]);
    for (Index s = fidelity_.first[t]; s >= 0; s = fidelity_.samples[s].next) {
      const Sample& sample = fidelity_.samples[s];
      const ClosestPoint c = frame.closest(sample.point);
      for (int k = 0; k < 3; ++k) pull[k] += sample.weight * c.barycentric[k];
    }
    for (int k = 0; k < 3; ++k)
      corner_gradient_[t][k] = {stiffness, pull[k] * fidelity_.weights.to_mesh, 0};
  });
  blocks_.resize(vertices);
  workers_.for_each(vertices, kChunk, [&](std::size_t v) {
    Vec3 sum;
    for (Index c = corner_start_[v]; c < corner_start_[v + 1]; ++c)
      sum += corner_gradient_[corner_[c] / 3][corner_[c] % 3];
    const double surface =
        4 * fidelity_.vertex_stiffness(static_cast<Index>(v), mesh_.positions[v]);
    const double tangential = sum.x + 0.3 * sum.y;
    const double vertical = 0.3 * sum.x + 2 * sum.y + surface;
    blocks_[v] = {fidelity_.vertex_planes[v].normal, 1 / tangential, 1 / vertical};
  });
  freeze_knots();
}

void GlobalDescent::freeze_knots() {
  Knots& knots = fidelity_.knots;
  knots.make_canonical();
  sliding_.clear();
  for (Index k = 0; k < static_cast<Index>(knots.all.size()); ++k)
    if (knots.all[k].slides && !knots.all[k].copies.empty()) sliding_.push_back(k);
  for (const Index k : sliding_) {
    double stiffness = 0;
    for (const Index v : knots.all[k].copies) stiffness += 1 / blocks_[v].tangential;
    blocks_[knots.all[k].copies.front()] = {{}, 1 / stiffness, 0};
  }
}

void GlobalDescent::knot_gradient(std::vector<Vec3>& gradient) const {
  for (const Index k : sliding_) {
    const SlidingKnot& knot = fidelity_.knots.all[k];
    Vec3 sum;
    for (const Index v : knot.copies) {
      for (Index c = corner_start_[v]; c < corner_start_[v + 1]; ++c)
        sum += corner_gradient_[corner_[c] / 3][corner_[c] % 3];
      fidelity_.vertex(v, mesh_.positions[v], &sum);
    }
    const Vec3 tangent = mesh::tangent_at(fidelity_.knots.curve(k), knot.place.arc);
    gradient[knot.copies.front()] = {dot(sum, tangent), 0, 0};
  }
}

void GlobalDescent::limit_knot_steps(std::vector<Vec3>& direction) const {
  for (const Index k : sliding_) {
    const Index v = fidelity_.knots.all[k].copies.front();
    const double local = fidelity_.size.at(v);
    const double step = std::clamp(direction[v].x, -kLongestStep * local, kLongestStep * local);
    direction[v] = {fidelity_.knots.limited(k, step, kKnotSpacing * local), 0, 0};
  }
}

double GlobalDescent::evaluate(std::vector<Vec3>& gradient) {
  const double triangles = workers_.ordered_sum(
      mesh_.triangle_capacity(), kChunk, 0.0, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Index t = static_cast<Index>(i);
          const std::array<Vec3, 3> p = corners(mesh_, t);
          if (collapsed_[i] != 0)
            corner_gradient_[i] = {};
          else
            sum += fidelity_.size.shape(mesh_.triangle(t), p, shape, corner_gradient_[i]);
          sum += fidelity_.triangle(t, p, &corner_gradient_[i]);
        }
        return sum;
      });
  gradient.resize(mesh_.vertex_capacity());
  const double vertices = workers_.ordered_sum(
      mesh_.vertex_capacity(), kChunk, 0.0, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          Vec3 g;
          for (Index c = corner_start_[i]; c < corner_start_[i + 1]; ++c)
            g += corner_gradient_[corner_[c] / 3][corner_[c] % 3];
          sum += fidelity_.vertex(static_cast<Index>(i), mesh_.positions[i], &g);
          if (fixed_[i]) g = {};
          if (on_surface_) g -= dot(g, blocks_[i].normal) * blocks_[i].normal;
          gradient[i] = g;
        }
        return sum;
      });
  knot_gradient(gradient);
  return triangles + vertices;
}

void GlobalDescent::precondition(std::span<const Vec3> in, std::span<Vec3> out) const {
  workers_.for_each(in.size(), 4 * kChunk, [&](std::size_t v) {
    const Block& b = blocks_[v];
    const double height = dot(in[v], b.normal);
    out[v] = b.tangential * in[v] + (b.vertical - b.tangential) * height * b.normal;
  });
}

void GlobalDescent::move(const std::vector<Vec3>& direction, double step) {
  workers_.for_each(direction.size(), kChunk, [&](std::size_t v) {
    if (fixed_[v]) return;
    mesh_.positions[v] = origin_[v] + step * direction[v];
    if (on_surface_ && !fixed_[v])
      mesh_.positions[v] =
          fidelity_.walk_foot(mesh_.positions[v], fidelity_.vertex_planes[v].facet).point;
  });
  Knots& knots = fidelity_.knots;
  for (std::size_t i = 0; i < sliding_.size(); ++i)
    knots.move(mesh_, sliding_[i],
               arc_origin_[i] + step * direction[knots.all[sliding_[i]].copies.front()].x);
}

void GlobalDescent::put_back() {
  mesh_.positions = origin_;
  for (std::size_t i = 0; i < sliding_.size(); ++i)
    fidelity_.knots.all[sliding_[i]].place.arc = arc_origin_[i];
}

bool GlobalDescent::search_line(const std::vector<Vec3>& direction, double slope,
                                double first_step) {
  double step = first_step;
  for (int i = 0; i <= kHalvings; ++i, step *= 0.5) {
    move(direction, step);
    const double trial = evaluate(trial_gradient_);
    if (trial <= energy_ + 1e-4 * step * slope) {
      energy_ = trial;
      return true;
    }
  }
  put_back();
  return false;
}

void GlobalDescent::run(int iterations, const std::function<bool()>& keep_going) {
  energy_ = evaluate(gradient_);
  std::vector<Vec3> direction(gradient_.size()), change(gradient_.size());
  for (int i = 0; i < iterations && keep_going(); ++i) {
    history_.direction(
        gradient_, direction, [&](auto in, auto out) { precondition(in, out); }, workers_);
    for (std::size_t v = 0; v < direction.size(); ++v) {
      if (on_surface_) direction[v] -= dot(direction[v], blocks_[v].normal) * blocks_[v].normal;
      const double l = length(direction[v]);
      if (fixed_[v])
        direction[v] = {direction[v].x, 0, 0};  // a knot's step; zero for those that stay
      else if (l > kLongestStep * fidelity_.size.at(static_cast<Index>(v)))
        direction[v] *= kLongestStep * fidelity_.size.at(static_cast<Index>(v)) / l;
    }
    limit_knot_steps(direction);
    origin_ = mesh_.positions;
    arc_origin_.clear();
    for (const Index k : sliding_) arc_origin_.push_back(fidelity_.knots.all[k].place.arc);
    const double slope = optimize::dot(direction, gradient_, workers_);
    const bool fresh = history_.size() == 0;
    if (slope >= 0 || !search_line(direction, slope, fresh ? 0.7 : 1.0)) {
      history_.clear();
      if (fresh) return;
      continue;
    }
    for (std::size_t v = 0; v < direction.size(); ++v) {
      direction[v] = mesh_.positions[v] - origin_[v];
      change[v] = trial_gradient_[v] - gradient_[v];
    }
    for (std::size_t j = 0; j < sliding_.size(); ++j) {
      const SlidingKnot& knot = fidelity_.knots.all[sliding_[j]];
      direction[knot.copies.front()] = {knot.place.arc - arc_origin_[j], 0, 0};
      for (std::size_t c = 1; c < knot.copies.size(); ++c) direction[knot.copies[c]] = {};
    }
    history_.add(direction, change, workers_);
    std::swap(gradient_, trial_gradient_);
  }
}

}  // namespace nonobtuse::refine
