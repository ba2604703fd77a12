#include "refine/distance_mending.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "refine/fold_mending.h"
#include "refine/largest_distance.h"
#include "refine/neighborhood.h"
#include "refine/valence_edits.h"
#include "refine/valence_mending.h"

namespace nonobtuse::refine {
namespace {

constexpr int kSequences = 10;     // of flips
constexpr int kPairSequences = 6;  // per vertex
constexpr int kAttempts = 24;      // places
// Trial passes times vertices, for all places together.
constexpr Index kEffort = 15000;
constexpr Index kPasses[] = {2, 40}, kThoroughPasses[] = {4, 80};  // per sequence, per attempt
constexpr double kInOrder = 5.5;   // largest distance to be content with, in root mean squares
constexpr double kLittle = 0.8;    // distances below this part of what is in order do not count
constexpr double kNear = 0.6;      // nor do those below this part of the largest
constexpr double kStillFar = 0.9;  // other centers to try: as far as this part of the largest
constexpr std::size_t kCenters = 3;
constexpr double kNewWeight = 0.2;  // of points of M that become samples
constexpr double kMuch = 0.85;      // what relaxation alone must bring the largest distance to
constexpr double kClearly = 0.95;   // and an edit

class DistanceMender {
 public:
  DistanceMender(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                 double enough, const parallel::Workers& workers)
      : mesh_(mesh),
        fidelity_(fidelity),
        options_(options),
        enough_(enough),
        workers_(workers),
        folds_(fidelity.surface()),
        far_points_(mesh, fidelity, enough, workers) {}

  [[nodiscard]] const std::vector<FarPoint>& far_points() const { return far_points_.list(); }

  // Cheap changes first.
  bool mend(const FarPoint& place) {
    options_.far = std::max(kLittle * enough_, kNear * place.distance);
    const Index t = place.triangle;
    options_.thorough = false;
    if (by_relaxation(t, 3) || by_flips(t, 3) || by_pair(t, 3) || by_flips(t, 2)) return true;
    options_.thorough = true;
    return by_flips(t, 3) || by_flips(t, 4);
  }

  [[nodiscard]] bool exhausted() const { return effort_ <= 0; }

 private:
  bool by_relaxation(Index t, int rings) {
    return commit_if_better(patch_around(t, rings), {{}}, kMuch);
  }

  bool by_flips(Index t, int rings) {
    const Patch patch = patch_around(t, rings);
    std::vector<std::vector<Edit>> sequences =
        search_neutral_flips(patch, local(patch, t), kSequences);
    sequences.insert(sequences.begin(), std::vector<Edit>{});
    return commit_if_better(patch, sequences, kClearly);
  }

  // A vertex more here, and one less elsewhere.
  bool by_pair(Index t, int rings) {
    const Patch patch = patch_around(t, rings);
    std::vector<std::vector<Edit>> sequences;
    for (Index v : local(patch, t))
      for (auto& edits : search_balancing_edits(patch, v, 1, kPairSequences))
        sequences.push_back(edits);
    std::optional<State> before;
    if (!commit_if_better(patch, sequences, kClearly, &before)) return false;
    std::vector<Index> touched;
    if (balance_count(mesh_, fidelity_, -1, options_, workers_, &touched)) {
      renew(touched);
      return true;
    }
    mesh_ = std::move(before->mesh);
    fidelity_ = std::move(before->fidelity);
    far_points_ = std::move(before->far_points);
    return false;
  }

  // What a change that cannot be balanced is taken back to.
  struct State {
    mesh::EditableMesh mesh;
    Fidelity fidelity;
    FarPoints far_points;
  };

  // Without samples whose foot is lost on a wrong sheet: what is nearest at all is much nearer.
  [[nodiscard]] Patch patch_around(Index t, int rings) const {
    Patch patch(mesh_, fidelity_, mesh_.triangle(t), rings);
    Fidelity& f = patch.fidelity;
    for (Index u = 0; u < patch.mesh.triangle_capacity(); ++u) {
      const std::array<Vec3, 3> p = corners(patch.mesh, u);
      const TriangleFrame frame(p[0], p[1], p[2]);
      for (Index* link = &f.first[u]; *link >= 0;) {
        Sample& sample = f.samples[*link];
        const double own = frame.closest(sample.point).squared_distance;
        if (own > options_.far * options_.far &&
            far_points_.squared_distance(sample.point, own) < 0.25 * own)
          *link = sample.next;
        else
          link = &sample.next;
      }
    }
    return patch;
  }

  [[nodiscard]] Triangle local(const Patch& patch, Index t) const {
    const Triangle& v = mesh_.triangle(t);
    return {patch.local(v[0]), patch.local(v[1]), patch.local(v[2])};
  }

  bool commit_if_better(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                        double part, std::optional<State>* state = nullptr) {
    const auto& passes = options_.thorough ? kThoroughPasses : kPasses;
    effort_ -= static_cast<Index>(patch.inner_vertices().size()) *
               (passes[0] * static_cast<Index>(sequences.size()) + passes[1]);
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options_, workers_, after);
    if (!best || !std::isfinite(after.energy)) return false;
    const PatchScore before = score(patch, options_);
    if (after.folded > before.folded || after.bad_valence > before.bad_valence ||
        after.outside_promise > before.outside_promise ||
        after.outside_goal > before.outside_goal || !(after.distance < part * before.distance) ||
        folds_.count(*best) > folds_.count(patch))
      return false;
    if (state) state->emplace(State{mesh_, fidelity_, far_points_});
    renew(best->commit(mesh_, fidelity_));
    return true;
  }

  // After a change of the triangles `touched`.
  void renew(std::vector<Index> touched) {
    std::erase_if(touched, [&](Index t) { return !mesh_.alive_triangle(t); });
    const std::vector<Index> around = triangles_around(mesh_, dilated(mesh_, touched, 0));
    fidelity_.emphasize_far_ridges(mesh_, enough_, kNewWeight, 1, workers_,
                                   FarRidges::VerticesAndEdges, &around);
    far_points_.update(touched, around);
  }

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  TrialOptions options_;
  double enough_;
  Index effort_ = kEffort;
  const parallel::Workers& workers_;
  FoldTest folds_;
  FarPoints far_points_;
};

}  // namespace

Index mend_distance(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                    const parallel::Workers& workers,
                    const std::function<bool(double)>& keep_going) {
  const double enough = kInOrder * std::sqrt(fidelity.mean_square(mesh));
  TrialOptions strict = options;
  strict.promise = strict.goal;
  fidelity.emphasize_far_ridges(mesh, enough, kNewWeight, 1, workers, FarRidges::VerticesAndEdges);
  DistanceMender mender(mesh, fidelity, strict, enough, workers);
  Index changes = 0;
  std::size_t stuck = 0;  // centers that nothing helped at, among the farthest
  for (int attempt = 0;
       attempt < kAttempts && !mender.exhausted() && stuck < mender.far_points().size();
       ++attempt) {
    if (!keep_going(static_cast<double>(attempt) / kAttempts)) break;
    const FarPoint place = mender.far_points()[stuck];
    if (place.distance < kStillFar * mender.far_points().front().distance) break;
    if (mender.mend(place)) {
      ++changes;
      stuck = 0;
    } else if (++stuck == kCenters) {
      break;
    }
  }
  return changes;
}

}  // namespace nonobtuse::refine
