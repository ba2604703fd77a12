// Why no Voronoi diagram: after plain CVT the connectivity is nearly right, and the mesh's own
// triangles tell shape, angles and distance at a fifth of the cost. Vertices may leave the surface
// by the small offset that minimises the two-sided distance, which takes away most of the conflict
// between angles and fidelity.
#include "remesh/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "refine/angle_goal.h"
#include "refine/angle_sweeps.h"
#include "refine/distance_mending.h"
#include "refine/fidelity.h"
#include "refine/flips.h"
#include "refine/fold_mending.h"
#include "refine/global_descent.h"
#include "refine/sheet_separation.h"
#include "refine/valence_mending.h"
#include "remesh/restricted_diagram.h"

namespace nonobtuse::pipeline {
namespace {

constexpr Index kSamplesPerVertex = 8;
constexpr int kStepsBetweenFlips = 5;
constexpr int kStepsToSettle = 14;
constexpr int kStepsIfSettled = 10;
constexpr double kFidelity = 20;  // weight at the start
constexpr double kLeastFidelity = 6;
constexpr double kMostFidelity = 40;
// Weight of the circumcentres where the least fidelity leaves too little shape.
constexpr double kMostCircumcentre = 8;
constexpr int kStiffBlocks = 2;
// Q_avg aimed at by the weight, for fewer and for more than 10000 vertices.
constexpr double kMeanQuality = 0.9465;
constexpr double kMeanQualityLarge = 0.9425;
constexpr double kMeanQualitySized = 0.932;  // gradation costs shape
constexpr double kFarFactor = 5;  // vertices of M farther than this many rms distances are far
constexpr double kFarWeight = 0.2;
constexpr double kFarGrowth = 2;
constexpr double kLeash = 0.05;  // where the size is 1
constexpr double kMendingLeash = 0.2;
// Budget of the trials beside creases and boundaries.
constexpr std::int64_t kTrialWork = 40000;
constexpr std::int64_t kTrialWorkPerVertex = 100;
constexpr Index kManyVertices = 10000;  // whose places are not searched again and again

class Refinement {
 public:
  Refinement(const mesh::Surface& surface, mesh::EditableMesh& mesh,
             const spatial::TriangleBvh& bvh, const RefinementOptions& options,
             const parallel::Workers& workers, parallel::Monitor& monitor,
             const mesh::CurveNetwork* curves)
      : mesh_(mesh),
        options_(options),
        workers_(workers),
        monitor_(monitor),
        fidelity_(surface, bvh),
        descent_(mesh, fidelity_, options.on_surface, workers) {
    fidelity_.weights = {kFidelity, kFidelity};
    if (options.on_surface) fidelity_.weights.to_surface = 0;
    if (!surface.size.empty()) fidelity_.size.measure(mesh);
    fidelity_.attach_curves(mesh, curves, workers);
    fidelity_.samples = refine::sample_surface(surface, kSamplesPerVertex * mesh.vertex_count());
    fidelity_.search_samples(mesh, workers);
    fidelity_.update_planes(mesh, workers);
  }

  /// Where the knots are now.
  void store_knots(mesh::CurveNetwork& curves) const { fidelity_.knots.store(curves); }

  Index run() {
    const double lo = options_.min_angle, hi = options_.max_angle;
    // First wide open, so that shape and fidelity find their balance; then two degrees inside.
    energy::ShapeWeights shape = energy::hinged(10, std::min(35.0, lo - 5), std::max(86.0, hi + 5));
    descend(options_.settled ? kStepsIfSettled : kStepsToSettle, shape, 0, 0.25);
    adapt_weights();
    for (int block = 0; block < kStiffBlocks && circumcentre_ > 1; ++block) {
      shape.circumcentre = circumcentre_;
      descend(kStepsIfSettled, shape, 0.25, 0.3);
      adapt_weights();
    }
    shape = energy::hinged(20, lo + 2, hi - 2);
    // Beside creases the connectivity is less free, and vertices would rather leave the surface.
    if (!fidelity_.knots.empty()) fidelity_.leash = kLeash;
    for (int round = 0; round < 3; ++round) {
      if (monitor_.cancelled()) return outside_goal({lo, hi});
      const double far = kFarFactor * std::sqrt(fidelity_.mean_square(mesh_));
      fidelity_.emphasize_far_points(mesh_, circumcentre_ > 1 ? far : 2 * far, kFarGrowth);
      fidelity_.emphasize_far_ridges(mesh_, far, kFarWeight, kFarGrowth, workers_);
      if (round > 0) adapt_weights();
      shape.circumcentre = circumcentre_;
      descend(8, shape, 0.3 + 0.15 * round, 0.45 + 0.15 * round);
    }
    const refine::AngleGoal goal{lo, hi};
    if (monitor_.cancelled()) return outside_goal(goal);
    refine::TrialOptions local;
    local.goal = goal;
    local.shape = energy::hinged(100, lo + 1, hi - 1);
    local.shape.circumcentre = circumcentre_;
    local.on_surface = options_.on_surface;
    refine::TrialBudget budget(kTrialWork + kTrialWorkPerVertex * mesh_.vertex_count());
    if (mesh_.vertex_count() > kManyVertices) budget.places.emplace();
    if (!fidelity_.knots.empty()) local.budget = &budget;
    Index outside = mend_and_sweep(local);
    // Beside creases a second attempt finds a mesh in better order.
    for (int attempt = 0; attempt < 2 && outside > 0 && !fidelity_.knots.empty(); ++attempt)
      outside = mend_and_sweep(local);
    if (local.budget) keep_promise();
    local.budget = nullptr;
    lower_distances(local);
    return outside == 0 ? 0 : outside_goal(goal);
  }

 private:
  Index mend_and_sweep(const refine::TrialOptions& local) {
    fidelity_.valences.measure(mesh_);
    // New connectivity needs room to settle.
    const double leash = fidelity_.leash;
    fidelity_.leash = kMendingLeash / kLeash * leash;
    refine::mend_valences(mesh_, fidelity_, local, false, workers_, [&] { return tick(0.75); });
    fidelity_.leash = leash;
    return refine::sweep_angles(
        mesh_, fidelity_, local.goal, options_.on_surface, workers_,
        [&](double f) { return tick(0.75 + 0.15 * f); }, local.budget, circumcentre_);
  }

  // Sheets apart, folds undone, largest distances lowered; beside creases not at the cost of the
  // promise, which these steps do not tell from the goal.
  void lower_distances(const refine::TrialOptions& local) {
    const std::size_t broken = outside_promise();
    std::optional<std::pair<mesh::EditableMesh, refine::Fidelity>> before;
    if (!fidelity_.knots.empty()) before.emplace(mesh_, fidelity_);
    const Index crossings = refine::separate_sheets(mesh_, fidelity_, local, workers_,
                                                    [&](double f) { return tick(0.9 + 0.01 * f); });
    refine::mend_folds(
        mesh_, fidelity_, local, workers_, [&] { return tick(0.92); }, crossings > 0);
    if (refine::mend_distance(mesh_, fidelity_, local, workers_,
                              [&](double f) { return tick(0.93 + 0.05 * f); }) > 0)
      refine::separate_sheets(mesh_, fidelity_, local, workers_,
                              [&](double f) { return tick(0.98 + 0.02 * f); });
    if (!before || outside_promise() <= broken) return;
    keep_promise();
    if (outside_promise() <= broken) return;
    mesh_ = std::move(before->first);
    fidelity_ = std::move(before->second);
  }

  [[nodiscard]] std::size_t outside_promise() const {
    return refine::triangles_outside(mesh_, refine::AngleTest(refine::kPromise)).size();
  }

  // Where not even the promise is kept, bounds so far inside only stand in the way.
  void keep_promise() {
    if (outside_promise() == 0) return;
    const refine::AngleGoal least{std::min(options_.min_angle, refine::kPromise.smallest + 1),
                                  std::max(options_.max_angle, refine::kPromise.largest - 1)};
    refine::TrialBudget budget(kTrialWork + kTrialWorkPerVertex / 4 * mesh_.vertex_count());
    if (mesh_.vertex_count() > kManyVertices) budget.places.emplace();
    refine::sweep_angles(
        mesh_, fidelity_, least, options_.on_surface, workers_,
        [&](double f) { return tick(0.85 + 0.05 * f); }, &budget, circumcentre_);
  }

  bool tick(double fraction) {
    return monitor_.tick_counting(fraction, [&] { return refine::count_obtuse(mesh_); });
  }

  void record() {
    if (!monitor_.recording()) return;
    std::vector<Vec3> gradient;
    const double energy = descent_.evaluate(gradient);
    const TriangleMesh now = mesh_.to_mesh();
    const BadTriangles bad = count_bad_triangles(now.vertices, now.triangles);
    monitor_.record(done_, energy, bad.obtuse, bad.small);
  }

  [[nodiscard]] Index outside_goal(const refine::AngleGoal& goal) const {
    return static_cast<Index>(refine::triangles_outside(mesh_, refine::AngleTest(goal)).size());
  }

  // Fidelity is bought with shape, not with the angle bounds: on a smooth surface there is shape to
  // spare, on a rough one there is not.
  void adapt_weights() {
    const double aim = !fidelity_.size.uniform()      ? kMeanQualitySized
                       : mesh_.vertex_count() > 10000 ? kMeanQualityLarge
                                                      : kMeanQuality;
    const double excess = refine::mean_quality(mesh_) - aim;
    // exp(x) in Pade's form: libm's own bits differ from system to system.
    const double x = std::clamp(150 * excess, -3.0, 3.0);
    const double factor = (12 + 6 * x + x * x) / (12 - 6 * x + x * x);
    // Below the least fidelity distances would grow faster than shape improves. Instead stiffer
    // triangles take from the cells their equal sizes, which nothing here depends on.
    const bool stiffens = fidelity_.size.uniform() && fidelity_.knots.empty();
    const double balance =
        std::clamp(fidelity_.weights.to_mesh / circumcentre_ * factor,
                   stiffens ? kLeastFidelity / kMostCircumcentre : kLeastFidelity, kMostFidelity);
    const double weight = std::max(balance, kLeastFidelity);
    circumcentre_ = weight / balance;
    fidelity_.weights.to_mesh = weight;
    if (!options_.on_surface) fidelity_.weights.to_surface = weight;
  }

  // L-BFGS in blocks of a few steps; flips, samples, planes and preconditioner are renewed between.
  void descend(int iterations, const energy::ShapeWeights& shape, double from, double to) {
    descent_.shape = shape;
    for (int done = 0; done < iterations; done += kStepsBetweenFlips) {
      if (!tick(from + (to - from) * done / iterations)) return;
      fidelity_.walk_samples(mesh_, workers_);
      refine::flip_edges(mesh_, fidelity_, shape);
      fidelity_.update_planes(mesh_, workers_);
      descent_.freeze();
      if (done_ == 0) record();
      const int steps = std::min(kStepsBetweenFlips, iterations - done);
      descent_.run(steps, [&] { return !monitor_.cancelled(); });
      done_ += steps;
      record();
    }
    if (monitor_.cancelled()) return;
    fidelity_.walk_samples(mesh_, workers_);
    refine::flip_edges(mesh_, fidelity_, shape);
    fidelity_.update_planes(mesh_, workers_);
  }

  mesh::EditableMesh& mesh_;
  RefinementOptions options_;
  const parallel::Workers& workers_;
  parallel::Monitor& monitor_;
  refine::Fidelity fidelity_;
  refine::GlobalDescent descent_;
  double circumcentre_ = 1;  // weight of the triangles' shape beside that of the cells
  int done_ = 0;             // iterations of the descents so far
};

}  // namespace

Index refine(const mesh::Surface& surface, const spatial::TriangleBvh& bvh,
             mesh::EditableMesh& mesh, const RefinementOptions& options,
             const parallel::Workers& workers, parallel::Monitor& monitor,
             mesh::CurveNetwork* curves) {
  if (mesh.vertex_capacity() != mesh.vertex_count() ||
      mesh.triangle_capacity() != mesh.triangle_count())
    mesh.compact();
  if (monitor.cancelled()) {
    const refine::AngleTest test({options.min_angle, options.max_angle});
    return static_cast<Index>(refine::triangles_outside(mesh, test).size());
  }
  Refinement refinement(surface, mesh, bvh, options, workers, monitor, curves);
  const Index outside = refinement.run();
  if (curves) refinement.store_knots(*curves);
  mesh.compact();
  return outside;
}

}  // namespace nonobtuse::pipeline
