#include "remesh/valence_resampling.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "numeric/random.h"
#include "numeric/vec3.h"
#include "remesh/restricted_diagram.h"

namespace nonobtuse::pipeline {

namespace {

// Who is whose neighbour in a restricted Delaunay triangulation.
class Neighborhood {
 public:
  Neighborhood(const RestrictedDiagram& diagram, std::size_t sites)
      : start_(sites + 1, 0), triangle_count_(sites, 0) {
    for (const auto& e : diagram.edges) {
      ++start_[e.site + 1];
      ++start_[e.other + 1];
    }
    for (std::size_t i = 0; i < sites; ++i) start_[i + 1] += start_[i];
    neighbors_.resize(start_[sites]);
    std::vector<Index> fill(start_.begin(), start_.end() - 1);
    for (const auto& e : diagram.edges) {
      neighbors_[fill[e.site]++] = e.other;
      neighbors_[fill[e.other]++] = e.site;
    }
    for (const Triangle& t : diagram.triangles)
      for (const Index v : t) ++triangle_count_[v];
  }

  [[nodiscard]] std::span<const Index> of(Index i) const {
    return {neighbors_.data() + start_[i], neighbors_.data() + start_[i + 1]};
  }
  [[nodiscard]] Index valence(Index i) const { return start_[i + 1] - start_[i]; }
  // A site inside whose cell is a disc has as many triangles as edges.
  [[nodiscard]] bool regular(Index i) const { return valence(i) == triangle_count_[i]; }
  [[nodiscard]] bool bad(Index i) const { return regular(i) && (valence(i) < 5 || valence(i) > 7); }
  // i and all within `rings` edges of it, in breadth-first order.
  [[nodiscard]] std::vector<Index> ring(Index i, int rings) const {
    std::vector<Index> found{i};
    std::size_t begin = 0;
    for (int r = 0; r < rings; ++r) {
      const std::size_t end = found.size();
      for (; begin < end; ++begin)
        for (const Index j : of(found[begin]))
          if (std::find(found.begin(), found.end(), j) == found.end()) found.push_back(j);
    }
    return found;
  }

 private:
  std::vector<Index> start_;
  std::vector<Index> neighbors_;
  std::vector<Index> triangle_count_;
};

// One bad site with the sites that may move for it, and those whose valence may change.
struct Attempt {
  Index site;
  std::vector<Index> moving;
  std::vector<Index> watched;
  int bad = 0;
};

// Cells that are not discs count as well: an attempt must not trade a valence for a defect of the
// topology.
int count_bad(const Neighborhood& near, std::span<const Index> sites) {
  int bad = 0;
  for (const Index i : sites) bad += near.bad(i) || !near.regular(i);
  return bad;
}

// Bad sites, in order of index, whose surroundings do not overlap.
std::vector<Attempt> choose_attempts(const Neighborhood& near, std::size_t sites) {
  std::vector<Attempt> attempts;
  std::vector<bool> taken(sites, false);
  for (std::size_t i = 0; i < sites; ++i) {
    const Index site = static_cast<Index>(i);
    if (!near.bad(site)) continue;
    Attempt a{site, near.ring(site, 3), near.ring(site, 5)};
    if (std::any_of(a.watched.begin(), a.watched.end(), [&](Index j) { return taken[j]; }))
      continue;
    for (const Index j : a.watched) taken[j] = true;
    a.bad = count_bad(near, a.watched);
    attempts.push_back(std::move(a));
  }
  return attempts;
}

// A random place within about `rings` edges of the site: in a random triangle of a random site
// there, seen from that site.
Vec3 random_place(const Neighborhood& near, const PlacedSites& placed, Index site, int rings,
                  numeric::Random& random) {
  const std::vector<Index> choice = near.ring(site, rings - 1);
  const Index base = choice[random.below(choice.size())];
  const std::span<const Index> around = near.of(base);
  const Vec3 p = placed.sites[base];
  if (around.empty()) return p;  // a site without a cell
  const Vec3 a = placed.sites[around[random.below(around.size())]] - p;
  const Vec3 b = placed.sites[around[random.below(around.size())]] - p;
  double u = random.uniform();
  double v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return p + u * a + v * b;
}

}  // namespace

Index resample_bad_valences(const mesh::Surface& surface, const SurfaceProjection& projection,
                            PlacedSites& placed, int rounds, std::uint64_t seed,
                            const parallel::Workers& workers, parallel::Monitor& monitor) {
  constexpr int kLloydSteps = 3;
  const std::size_t n = placed.sites.size();
  Neighborhood near(restricted_diagram(surface, placed.sites, workers), n);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Attempt> attempts = choose_attempts(near, n);
    if (attempts.empty()) break;
    PlacedSites trial = placed;
    for (const Attempt& a : attempts) {
      numeric::Random random(seed + static_cast<std::uint64_t>(round),
                             static_cast<std::uint64_t>(a.site));
      const Vec3 place = random_place(near, placed, a.site, 1 + round / 4, random);
      projection.step(trial, a.site, place - placed.sites[a.site]);
    }
    for (int step = 0; step < kLloydSteps; ++step) {
      if (!monitor.tick(static_cast<double>(round) / rounds)) return 0;
      const RestrictedDiagram diagram = restricted_diagram(surface, trial.sites, workers);
      for (const Attempt& a : attempts)
        for (const Index i : a.moving)
          projection.step(trial, i, diagram.cells.centroid[i] - trial.sites[i]);
    }
    const Neighborhood after(restricted_diagram(surface, trial.sites, workers), n);
    bool changed = false;
    for (const Attempt& a : attempts) {
      if (count_bad(after, a.watched) >= a.bad) continue;
      changed = true;
      for (const Index i : a.moving) {
        placed.sites[i] = trial.sites[i];
        placed.normals[i] = trial.normals[i];
      }
    }
    if (changed) near = Neighborhood(restricted_diagram(surface, placed.sites, workers), n);
  }
  Index bad = 0;
  for (std::size_t i = 0; i < n; ++i) bad += near.bad(static_cast<Index>(i));
  return bad;
}

}  // namespace nonobtuse::pipeline
