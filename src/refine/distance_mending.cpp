// What holds the largest distance up is mostly the connectivity at a tip: relaxation alone ends at
// a balance between distance and angles. Around the farthest points other connectivity is tried,
// a vertex more first, each relaxed for the largest distance.
#include "refine/distance_mending.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "refine/fold_mending.h"
#include "refine/largest_distance.h"
#include "refine/minimax_relaxation.h"
#include "refine/neighborhood.h"
#include "refine/valence_edits.h"
#include "refine/valence_mending.h"

namespace nonobtuse::refine {
namespace {

constexpr int kSequences = 10;     // of flips
constexpr int kPairSequences = 6;  // per vertex
constexpr int kAttempts = 24;      // places
constexpr int kClusterRounds = 12;
constexpr int kClusterRings = 3;
// Vertices moved, once in every pass, for all places together.
constexpr std::int64_t kEffort = 26000;
constexpr double kInOrder = 5.5;    // largest distance to be content with, in root mean squares
constexpr double kLittle = 0.8;     // distances below this part of what is in order do not count
constexpr double kNear = 0.6;       // nor do those below this part of the largest
constexpr double kInCluster = 0.5;  // places of clusters: as far as this part of the largest
constexpr double kStillFar = 0.9;   // other centers to try: as far as this part of the largest
constexpr std::size_t kCenters = 3;
constexpr double kNewWeight = 0.2;  // of points of M that become samples
constexpr double kClearly = 0.95;   // what an edit must bring the largest distance to

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
        far_points_(mesh, fidelity, enough, workers) {
    options_.budget = &budget_;
  }

  [[nodiscard]] const std::vector<FarPoint>& far_points() const { return far_points_.list(); }

  // Relaxes all places at once, those near each other together. Returns the clusters changed.
  Index relax_clusters() {
    std::vector<Index> far;
    for (const FarPoint& p : far_points())
      if (p.distance > kInCluster * far_points().front().distance) far.push_back(p.triangle);
    sort_unique(far);
    const std::vector<Index> zone = triangles_around(mesh_, dilated(mesh_, far, 1));
    look_closely(zone);
    std::vector<std::vector<Index>> clusters = clusters_of(far);
    struct Relaxed {
      Patch before;
      MinimaxRelaxation after;
    };
    std::vector<std::optional<Relaxed>> relaxed(clusters.size());
    workers_.for_each(clusters.size(), 1, [&](std::size_t i) {
      TrialOptions options = options_;
      options.far = kLittle * enough_;
      Patch patch = patch_around(clusters[i], kClusterRings - 1);
      const double largest = largest_distance(patch.mesh, patch.fidelity, options.far);
      options.far = std::max(options.far, kNear * largest);
      MinimaxRelaxation relaxation(patch, options, score(patch, options));
      relaxed[i].emplace(Relaxed{std::move(patch), std::move(relaxation)});
      relaxed[i]->after.run(kClusterRounds);
    });
    Index changes = 0;
    for (auto& r : relaxed) {
      options_.far = kLittle * enough_;
      changes += commit_if_better(r->before, std::move(*r->after.best), r->after.best_score, 1);
    }
    return changes;
  }

  bool mend(const FarPoint& place) {
    options_.far = std::max(kLittle * enough_, kNear * place.distance);
    const Index t = place.triangle;
    return by_pair(t, 2) || by_pair(t, 3) || by_flips(t, 2) || by_flips(t, 3);
  }

  [[nodiscard]] bool exhausted() const { return budget_.exhausted(); }

 private:
  // Triangles parted so that the patches around the parts do not overlap, each part as vertices.
  [[nodiscard]] std::vector<std::vector<Index>> clusters_of(const std::vector<Index>& far) const {
    const std::vector<Index> zone = triangles_around(mesh_, dilated(mesh_, far, kClusterRings));
    std::vector<Index> cluster(zone.size(), -1);
    const auto place = [&](Index t) {
      const auto it = std::lower_bound(zone.begin(), zone.end(), t);
      return it != zone.end() && *it == t ? static_cast<Index>(it - zone.begin()) : Index{-1};
    };
    std::vector<std::vector<Index>> clusters;
    std::vector<Index> reached;
    for (const Index start : far) {
      if (cluster[place(start)] < 0) {
        const auto number = static_cast<Index>(clusters.size());
        clusters.emplace_back();
        reached.assign(1, place(start));
        cluster[reached.front()] = number;
        while (!reached.empty()) {
          const Index t = zone[reached.back()];
          reached.pop_back();
          for (int k = 0; k < 3; ++k) {
            const Index next = mesh_.adjacent(t, k) < 0 ? -1 : place(mesh_.adjacent(t, k));
            if (next < 0 || cluster[next] >= 0) continue;
            cluster[next] = number;
            reached.push_back(next);
          }
        }
      }
      std::vector<Index>& own = clusters[cluster[place(start)]];
      own.insert(own.end(), mesh_.triangle(start).begin(), mesh_.triangle(start).end());
    }
    for (std::vector<Index>& c : clusters) sort_unique(c);
    return clusters;
  }

  bool by_flips(Index t, int rings) {
    const Patch patch = patch_around(mesh_.triangle(t), rings);
    std::vector<std::vector<Edit>> sequences =
        search_neutral_flips(patch, local(patch, t), kSequences);
    sequences.insert(sequences.begin(), std::vector<Edit>{});
    return commit_best(patch, sequences);
  }

  // A vertex more here, and one less elsewhere.
  bool by_pair(Index t, int rings) {
    const Patch patch = patch_around(mesh_.triangle(t), rings);
    std::vector<std::vector<Edit>> sequences;
    for (Index v : local(patch, t))
      for (auto& edits : search_balancing_edits(patch, v, 1, kPairSequences))
        sequences.push_back(edits);
    std::optional<State> before;
    if (!commit_best(patch, sequences, &before)) return false;
    std::vector<Index> touched;
    TrialOptions elsewhere = options_;
    elsewhere.budget = nullptr;
    if (balance_count(mesh_, fidelity_, -1, elsewhere, workers_, &touched)) {
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
  [[nodiscard]] Patch patch_around(std::span<const Index> center, int rings) const {
    Patch patch(mesh_, fidelity_, center, rings);
    Fidelity& f = patch.fidelity;
    for (Index u = 0; u < patch.mesh.triangle_capacity(); ++u) {
      const std::array<Vec3, 3> p = corners(patch.mesh, u);
      const TriangleFrame frame(p[0], p[1], p[2]);
      for (Index* link = &f.first[u]; *link >= 0;) {
        Sample& sample = f.samples[*link];
        const double own = frame.closest(sample.point).squared_distance;
        if (own > enough_ * enough_ && far_points_.squared_distance(sample.point, own) < 0.25 * own)
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

  bool commit_best(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                   std::optional<State>* state = nullptr) {
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options_, workers_, after);
    return best && commit_if_better(patch, std::move(*best), after, kClearly, state);
  }

  bool commit_if_better(const Patch& patch, Patch best, PatchScore after, double part,
                        std::optional<State>* state = nullptr) {
    if (!std::isfinite(after.energy)) return false;
    const PatchScore before = score(patch, options_);
    after.distance = largest_distance(best.mesh, best.fidelity, options_.far);
    if (after.folded > before.folded || after.bad_valence > before.bad_valence ||
        after.outside_promise > before.outside_promise ||
        after.outside_goal > before.outside_goal || !(after.distance < part * before.distance) ||
        folds_.count(best) > folds_.count(patch))
      return false;
    if (state) state->emplace(State{mesh_, fidelity_, far_points_});
    renew(best.commit(mesh_, fidelity_));
    return true;
  }

  // After a change of the triangles `touched`.
  void renew(std::vector<Index> touched) {
    std::erase_if(touched, [&](Index t) { return !mesh_.alive_triangle(t); });
    const std::vector<Index> around = triangles_around(mesh_, dilated(mesh_, touched, 0));
    look_closely(around, touched);
  }

  // Adds what is far of the surface near these triangles to the samples, and measures them anew.
  void look_closely(const std::vector<Index>& around, const std::vector<Index>& changed = {}) {
    fidelity_.emphasize_far_ridges(mesh_, enough_, kNewWeight, 1, workers_, &around);
    far_points_.update(changed, around);
  }

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  TrialOptions options_;
  double enough_;
  TrialBudget budget_{kEffort};
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
  fidelity.emphasize_far_ridges(mesh, enough, kNewWeight, 1, workers);
  DistanceMender mender(mesh, fidelity, strict, enough, workers);
  if (mender.far_points().empty()) return 0;
  Index changes = mender.relax_clusters();
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
