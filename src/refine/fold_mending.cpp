// A pleat costs the relaxation nothing once it is there: every triangle is well shaped and near the
// surface. So trials are compared by how many folds they leave before anything else.
#include "refine/fold_mending.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "refine/angle_sweeps.h"
#include "refine/crossing_triangles.h"
#include "refine/neighborhood.h"
#include "refine/valence_edits.h"
#include "refine/valence_mending.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::refine {
namespace {

constexpr int kSequences = 24;            // of flips
constexpr int kPairSequences = 6;         // per vertex
constexpr int kFirstOfTwo = 2;            // per vertex, where two vertices more or less are tried
constexpr int kAttempts = 12;             // places
constexpr std::int64_t kWork = 40000;     // budget of all trials
constexpr std::size_t kManyOutside = 50;  // triangles outside the goal that are not swept again
constexpr double kSuspicious = 0.5;  // cosine between a triangle's normal and what is around it

using Corners = std::array<Vec3, 3>;

bool meet(const spatial::Box& a, const spatial::Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

spatial::Box box_of(const Corners& c) {
  spatial::Box box;
  for (const Vec3& p : c) box.add(p);
  return box;
}

// Whether t may be turned over: it looks another way than the surface under its vertices, or than
// a neighbour.
bool is_suspicious(const mesh::EditableMesh& mesh, const Fidelity& fidelity, Index t) {
  const Vec3 normal = normalized(area_vector(corners(mesh, t)));
  for (const Index v : mesh.triangle(t)) {
    const Index facet = fidelity.vertex_planes[v].facet;
    if (facet >= 0 && dot(fidelity.surface().normals[facet], normal) < kSuspicious) return true;
  }
  for (int k = 0; k < 3; ++k) {
    const Index u = mesh.adjacent(t, k);
    if (u >= 0 && dot(normalized(area_vector(corners(mesh, u))), normal) < kSuspicious) return true;
  }
  return false;
}

// The vertices of every fold: of a triangle that is turned over, or of two that cross.
std::vector<std::vector<Index>> find_folds(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                                           const FoldTest& test, const parallel::Workers& workers,
                                           bool crossings) {
  std::vector<std::vector<Index>> folds;
  std::vector<std::pair<Index, Index>> pairs;
  if (crossings) pairs = crossing_triangles(mesh, fidelity.knots, workers);
  for (const auto& [a, b] : pairs) {
    std::vector<Index>& fold = folds.emplace_back();
    for (const Index t : {a, b})
      for (const Index v : mesh.triangle(t)) fold.push_back(v);
    sort_unique(fold);
  }
  std::vector<char> turned(mesh.triangle_capacity(), 0);
  workers.for_each(turned.size(), 256, [&](std::size_t i) {
    const Index t = static_cast<Index>(i);
    turned[t] = mesh.alive_triangle(t) && is_suspicious(mesh, fidelity, t) &&
                test.turned_over(mesh, fidelity, t);
  });
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (turned[t]) folds.emplace_back(mesh.triangle(t).begin(), mesh.triangle(t).end());
  return folds;
}

class FoldMender {
 public:
  FoldMender(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
             const FoldTest& test, const parallel::Workers& workers, bool crossings)
      : mesh_(mesh),
        fidelity_(fidelity),
        options_(options),
        test_(test),
        workers_(workers),
        folds_(find_folds(mesh, fidelity, test, workers, crossings)) {
    options_.folds = &test;
    options_.budget = &budget_;
  }

  [[nodiscard]] const std::vector<std::vector<Index>>& folds() const { return folds_; }
  [[nodiscard]] bool exhausted() const { return budget_.exhausted(); }

  // A pleat mostly has a vertex too many.
  bool mend(const std::vector<Index>& fold) {
    for (const int rings : {2, 3})
      if (by_pair(fold, rings, -1) || by_flips(fold, rings) || by_pair(fold, rings, 1)) return true;
    // A limb that bends sharply may want two.
    return by_pair(fold, 3, 2) || by_pair(fold, 3, -2);
  }

 private:
  bool by_flips(const std::vector<Index>& fold, int rings) {
    const Patch patch(mesh_, fidelity_, fold, rings);
    std::vector<std::vector<Edit>> sequences{{}};
    for (const Index t : fold_triangles(patch, fold))
      for (auto& edits : search_neutral_flips(patch, patch.mesh.triangle(t), kSequences))
        sequences.push_back(std::move(edits));
    return commit_if_better(patch, sequences, 0);
  }

  bool by_pair(const std::vector<Index>& fold, int rings, int net) {
    const Patch patch(mesh_, fidelity_, fold, rings);
    std::vector<std::vector<Edit>> sequences;
    const int step = net < 0 ? -1 : 1;
    const bool twice = net != step;
    for (const Index v : fold)
      for (auto& edits : search_balancing_edits(patch, patch.local(v), step,
                                                twice ? kFirstOfTwo : kPairSequences)) {
        if (twice)
          add_second(patch, edits, fold, step, sequences);
        else
          sequences.push_back(std::move(edits));
      }
    return commit_if_better(patch, sequences, net);
  }

  // Sequences that go on after `first` with one vertex more or less at what is left of the fold.
  static void add_second(const Patch& patch, const std::vector<Edit>& first,
                         const std::vector<Index>& fold, int net,
                         std::vector<std::vector<Edit>>& sequences) {
    Patch edited = patch;
    for (const Edit& edit : first) edited.apply(edit);
    for (const Index v : fold) {
      const Index u = patch.local(v);
      if (!edited.mesh.alive_vertex(u)) continue;
      for (auto& edits : search_balancing_edits(edited, u, net, kFirstOfTwo))
        sequences.push_back(std::move(edits));
    }
  }

  // Triangles of the patch with all corners in the fold.
  static std::vector<Index> fold_triangles(const Patch& patch, const std::vector<Index>& fold) {
    std::vector<Index> found;
    const auto in_fold = [&](Index v) {
      return std::find(fold.begin(), fold.end(), patch.vertex[v]) != fold.end();
    };
    for (Index t = 0; t < patch.mesh.triangle_capacity(); ++t) {
      const Triangle& v = patch.mesh.triangle(t);
      if (in_fold(v[0]) && in_fold(v[1]) && in_fold(v[2])) found.push_back(t);
    }
    return found;
  }

  [[nodiscard]] std::size_t outside() const {
    return triangles_outside(mesh_, AngleTest(options_.goal)).size();
  }

  // The angles may need more room than the patch has: what counts is how the whole mesh is after
  // the count is balanced and the angles are swept.
  bool commit_if_better(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                        int net) {
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options_, workers_, after);
    if (!best || !std::isfinite(after.energy)) return false;
    const PatchScore before = score(patch, options_);
    if (after.folded >= before.folded || after.bad_valence > before.bad_valence) return false;
    mesh::EditableMesh mesh_before = mesh_;
    Fidelity fidelity_before = fidelity_;
    const std::size_t outside_before = outside();
    best->commit(mesh_, fidelity_);
    TrialOptions elsewhere = options_;
    elsewhere.promise = elsewhere.goal;
    elsewhere.budget = nullptr;
    int unbalanced = net;
    while (unbalanced != 0) {
      const int back = unbalanced < 0 ? 1 : -1;
      if (!balance_count(mesh_, fidelity_, back, elsewhere, workers_)) break;
      unbalanced += back;
    }
    if (unbalanced == 0) {
      if (outside_before < kManyOutside)
        sweep_angles(
            mesh_, fidelity_, options_.goal, options_.on_surface, workers_,
            [](double) { return true; }, &budget_, options_.shape.circumcentre);
      std::vector<std::vector<Index>> folds = find_folds(mesh_, fidelity_, test_, workers_, true);
      if (folds.size() < folds_.size() && outside() <= outside_before) {
        folds_ = std::move(folds);
        return true;
      }
    }
    mesh_ = std::move(mesh_before);
    fidelity_ = std::move(fidelity_before);
    return false;
  }

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  TrialOptions options_;
  const FoldTest& test_;
  const parallel::Workers& workers_;
  std::vector<std::vector<Index>> folds_;
  TrialBudget budget_{kWork};
};

}  // namespace

FoldTest::FoldTest(const mesh::Surface& surface) : vertex_normals_(surface.vertices.size()) {
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (const Index v : surface.triangles[f])
      vertex_normals_[v] += surface.areas[f] * surface.normals[f];
}

bool FoldTest::turned_over(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                           Index t) const {
  const Corners p = corners(mesh, t);
  const Vec3 own = area_vector(p);
  const mesh::Surface& surface = fidelity.surface();
  const auto hit = fidelity.surface_bvh().closest((1.0 / 3) * (p[0] + p[1] + p[2]));
  if (!(dot(own, surface.normals[hit.triangle]) < 0)) return false;
  const Triangle& v = surface.triangles[hit.triangle];
  return dot(own, hit.barycentric.x * vertex_normals_[v[0]] +
                      hit.barycentric.y * vertex_normals_[v[1]] +
                      hit.barycentric.z * vertex_normals_[v[2]]) < 0;
}

Index FoldTest::count(const Patch& patch) const {
  std::vector<Index> triangles;
  std::vector<spatial::Box> boxes;
  Index count = 0;
  for (Index t = 0; t < patch.mesh.triangle_capacity(); ++t) {
    if (!patch.mesh.alive_triangle(t)) continue;
    count +=
        is_suspicious(patch.mesh, patch.fidelity, t) && turned_over(patch.mesh, patch.fidelity, t);
    const spatial::Box box = box_of(corners(patch.mesh, t));
    for (std::size_t i = 0; i < triangles.size(); ++i)
      count +=
          meet(box, boxes[i]) && properly_cross(patch.mesh, patch.fidelity.knots, t, triangles[i]);
    triangles.push_back(t);
    boxes.push_back(box);
  }
  return count;
}

Index mend_folds(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                 const parallel::Workers& workers, const std::function<bool()>& keep_going,
                 bool crossings) {
  const FoldTest test(fidelity.surface());
  FoldMender mender(mesh, fidelity, options, test, workers, crossings);
  Index changes = 0;
  std::size_t next = 0;  // those before resist
  for (int attempt = 0; attempt < kAttempts && next < mender.folds().size() && !mender.exhausted();
       ++attempt) {
    if (!keep_going()) break;
    const std::vector<Index> fold = mender.folds()[next];
    if (mender.mend(fold)) {
      ++changes;
      next = 0;
    } else {
      ++next;
    }
  }
  return changes;
}

}  // namespace nonobtuse::refine
