#include "rvd/cell_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvd/facet_clipping.h"

namespace nonobtuse::rvd {
namespace {

// All in units of h, the mean distance of neighbouring sites.
constexpr double kGridCell = 2.5;
constexpr double kLargestMargin = 0.1;
constexpr double kSmallestMargin = 1e-4;
constexpr double kFirstMargin = 0.02;
constexpr double kMarginPerStep = 3;  // times the last step nearby

struct CellSums {
  double mass = 0;
  Vec3 moment;
};

// What the linear interpolant of |x - x_i|^2 has too much over a piece, whatever the site: with
// linear density rho, A sum over the edges kl of |kl|^2 ((rho_k + rho_l) / 30 + rho_m / 60).
double flat_energy(const std::array<Vec3, 3>& v, double area, const std::array<double, 3>& rho) {
  double sum = 0;
  for (int m = 0; m < 3; ++m) {
    const int k = mesh::next(m);
    const int l = mesh::previous(m);
    sum += squared_distance(v[k], v[l]) * ((rho[k] + rho[l]) / 30 + rho[m] / 60);
  }
  return area * sum;
}

}  // namespace

// A list built with margin m stays exact while no listed site and no dropped one have moved by more
// than 2m together. What the listed ones moved is known; for all others stands the largest step of
// any site "nearby", that is in the chunk's box grown by `reach`, after the move. A site further
// away than `reach` cannot own a part of the chunk; once it comes nearer its steps count,
// including the one that brought it.
struct CellEvaluator::Chunk {
  Index begin = 0;
  Index end = 0;
  double spacing = 0;  // h, the local one
  spatial::Box box;
  double reach = -1;           // -1: nothing listed yet
  double last_step = 0;        // largest nearby
  std::vector<double> budget;  // #pieces: 2m less what was moved; negative: to be renewed
  std::vector<Index> start;    // #pieces + 1
  std::vector<Index> entries;  // positions in `table`, by ascending site
  std::vector<Index> table;    // the sites that stand in the lists
  std::vector<CellSums> sums;  // per site of the table
  std::vector<double> areas;   // the same, with sizes only
  double energy = 0;
  long long relisted = 0;
};

struct CellEvaluator::Scratch {
  explicit Scratch(Index site_count) : lister(site_count), slot(site_count, -1) {}
  CandidateLister lister;
  FacetClipper clipper;
  std::vector<Index> slot;  // #X: position in the new table, or -1
  std::vector<Index> gathered, base, list, start, entries, table;
  std::vector<double> radius, steps;
  std::vector<Vec3> points;
  std::vector<CornerDistances> distances;
  std::vector<Moments> moments;
};

CellEvaluator::CellEvaluator(const mesh::Surface& surface, Index site_count,
                             const parallel::Workers& workers)
    : workers_(workers),
      site_count_(site_count),
      pieces_(facet_pieces(surface, site_count)),
      pool_([site_count] { return std::make_unique<Scratch>(site_count); }) {
  if (!(pieces_.spacing > 0)) pieces_.spacing = 1;
  for (Index p = 0; p < pieces_.count(); ++p) {
    const auto [a, b, c] = pieces_.corners_of(p);
    if (!pieces_.uniform()) {
      flat_energy_ += flat_energy({a, b, c}, pieces_.area[p], pieces_.density_of(p));
      continue;
    }
    flat_energy_ += pieces_.area[p] / 12 *
                    (squared_distance(a, b) + squared_distance(b, c) + squared_distance(c, a));
  }
  chunks_.resize(pieces_.chunk_count());
  for (Index c = 0; c < pieces_.chunk_count(); ++c) {
    chunks_[c] = std::make_unique<Chunk>();
    chunks_[c]->begin = pieces_.chunk_start[c];
    chunks_[c]->end = pieces_.chunk_start[c + 1];
    chunks_[c]->box = pieces_.box[c];
    chunks_[c]->spacing = pieces_.chunk_spacing(c);
  }
}

CellEvaluator::~CellEvaluator() = default;

void CellEvaluator::reset() {
  previous_.clear();
  for (const auto& chunk : chunks_) chunk->reach = -1;
}

CellEvaluator::Statistics CellEvaluator::statistics() const {
  Statistics s;
  s.evaluations = evaluations_;
  s.pieces = evaluations_ * pieces_.count();
  for (const auto& chunk : chunks_) s.relisted += chunk->relisted;
  return s;
}

void CellEvaluator::evaluate(std::span<const Vec3> sites, CellIntegrals& out) {
  ++evaluations_;
  grid_.build(sites, kGridCell * pieces_.spacing);
  step_.assign(sites.size(), 0.0);
  if (!previous_.empty())
    for (std::size_t i = 0; i < sites.size(); ++i) step_[i] = distance(sites[i], previous_[i]);
  workers_.for_each(chunks_.size(), 1, [&](std::size_t c) {
    pool_.with([&](Scratch& scratch) {
      refresh(*chunks_[c], sites, scratch);
      integrate(*chunks_[c], sites, scratch);
    });
  });
  previous_.assign(sites.begin(), sites.end());
  sum_chunks(sites, out);
}

void CellEvaluator::refresh(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const {
  if (chunk.reach >= 0 && !spend_budgets(chunk, scratch)) return;
  find_bases(chunk, sites, scratch);
  relist(chunk, sites, scratch);
}

// Returns whether any list must be renewed.
bool CellEvaluator::spend_budgets(Chunk& chunk, Scratch& scratch) const {
  scratch.steps.clear();
  for (const Index site : chunk.table) scratch.steps.push_back(step_[site]);
  scratch.gathered.clear();
  grid_.gather(inflated(chunk.box, chunk.reach), scratch.gathered);
  double nearby = 0;
  for (const double step : scratch.steps) nearby = std::max(nearby, step);
  for (const Index site : scratch.gathered) nearby = std::max(nearby, step_[site]);
  chunk.last_step = nearby;
  if (nearby == 0) return false;
  bool renew = false;
  for (std::size_t p = 0; p < chunk.budget.size(); ++p) {
    double own = 0;
    for (Index e = chunk.start[p]; e < chunk.start[p + 1]; ++e)
      own = std::max(own, scratch.steps[chunk.entries[e]]);
    chunk.budget[p] -= own + nearby;
    renew |= chunk.budget[p] < 0;
  }
  return renew;
}

// For every piece whose list must be renewed a site about nearest to it, out of its old list.
void CellEvaluator::find_bases(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const {
  const Index count = chunk.end - chunk.begin;
  const bool first = chunk.reach < 0;
  scratch.base.assign(count, -1);
  scratch.radius.resize(count);
  double largest = 0;
  bool all = true;
  Index hint = 0;
  for (Index p = 0; p < count; ++p) {
    if (!first && chunk.budget[p] >= 0) {
      all = false;
      continue;
    }
    const std::array<Vec3, 3> corners = pieces_.corners_of(chunk.begin + p);
    if (first) {
      hint = grid_.nearest((corners[0] + corners[1] + corners[2]) / 3, hint);
      scratch.base[p] = hint;
      scratch.radius[p] = std::sqrt(farthest_corner2(corners, sites[hint]));
    } else {
      double least = std::numeric_limits<double>::infinity();
      for (Index e = chunk.start[p]; e < chunk.start[p + 1]; ++e) {
        const Index site = chunk.table[chunk.entries[e]];
        const double r2 = farthest_corner2(corners, sites[site]);
        if (r2 >= least) continue;
        least = r2;
        scratch.base[p] = site;
      }
      scratch.radius[p] = std::sqrt(least);
    }
    largest = std::max(largest, scratch.radius[p]);
    ++chunk.relisted;
  }
  const double needed = 1.001 * largest + 2 * kLargestMargin * chunk.spacing;
  chunk.reach = all ? needed : std::max(chunk.reach, needed);
  if (first) {
    chunk.budget.assign(count, -1.0);
    chunk.start.assign(count + 1, 0);
  }
}

void CellEvaluator::relist(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const {
  const Index count = chunk.end - chunk.begin;
  // Where sizes differ inside a chunk, so do the margins: lists of small cells would fill up.
  const auto margin_of = [&](Index p) {
    const double h = pieces_.piece_spacing(chunk.begin + p);
    return previous_.empty() ? kFirstMargin * h
                             : std::clamp(kMarginPerStep * chunk.last_step, kSmallestMargin * h,
                                          kLargestMargin * h);
  };
  scratch.lister.begin(grid_, sites, inflated(chunk.box, chunk.reach));
  for (Index p = 0; p < count; ++p)
    if (scratch.base[p] >= 0)
      scratch.lister.announce(scratch.base[p], scratch.radius[p], margin_of(p));

  scratch.start.assign(1, 0);
  scratch.entries.clear();
  scratch.table.clear();
  const auto add = [&](Index site) {
    Index& slot = scratch.slot[site];
    if (slot < 0) {
      slot = static_cast<Index>(scratch.table.size());
      scratch.table.push_back(site);
    }
    scratch.entries.push_back(slot);
  };
  for (Index p = 0; p < count; ++p) {
    if (scratch.base[p] < 0) {
      for (Index e = chunk.start[p]; e < chunk.start[p + 1]; ++e)
        add(chunk.table[chunk.entries[e]]);
    } else {
      const double radius = scratch.radius[p];
      const double margin = margin_of(p);
      const double valid =
          scratch.lister.list(pieces_.corners_of(chunk.begin + p), scratch.base[p], radius, margin,
                              0.5 * (chunk.reach - radius), scratch.list);
      chunk.budget[p] = 2 * valid;
      for (const Index site : scratch.list) add(site);
    }
    scratch.start.push_back(static_cast<Index>(scratch.entries.size()));
  }
  for (const Index site : scratch.table) scratch.slot[site] = -1;
  chunk.start.assign(scratch.start.begin(), scratch.start.end());
  chunk.entries.assign(scratch.entries.begin(), scratch.entries.end());
  chunk.table.assign(scratch.table.begin(), scratch.table.end());
}

void CellEvaluator::integrate(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const {
  if (!pieces_.uniform()) return integrate_weighted(chunk, sites, scratch);
  chunk.sums.assign(chunk.table.size(), {});
  scratch.points.clear();
  for (const Index site : chunk.table) scratch.points.push_back(sites[site]);
  const std::vector<Vec3>& points = scratch.points;
  double energy = 0;
  for (Index p = chunk.begin; p < chunk.end; ++p) {
    const Index* list = chunk.entries.data() + chunk.start[p - chunk.begin];
    const Index count = chunk.start[p - chunk.begin + 1] - chunk.start[p - chunk.begin];
    const std::array<Vec3, 3> v = pieces_.corners_of(p);
    const double area = pieces_.area[p];
    const auto distances = [&](Index k) -> CornerDistances {
      const Vec3& x = points[list[k]];
      return {squared_distance(v[0], x), squared_distance(v[1], x), squared_distance(v[2], x)};
    };
    const auto add = [&](Index k, const CornerDistances& d, const Moments& m) {
      CellSums& s = chunk.sums[list[k]];
      const Moments w{area * m[0], area * m[1], area * m[2]};
      s.mass += w[0] + w[1] + w[2];
      s.moment += w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
      energy += w[0] * d[0] + w[1] * d[1] + w[2] * d[2];
    };
    if (count == 1) {
      add(0, distances(0), kWhole);
    } else if (count == 2) {
      const CornerDistances a = distances(0);
      const CornerDistances b = distances(1);
      const Moments m = first_of_two({b[0] - a[0], b[1] - a[1], b[2] - a[2]});
      add(0, a, m);
      add(1, b, {1.0 / 3 - m[0], 1.0 / 3 - m[1], 1.0 / 3 - m[2]});
    } else {
      scratch.distances.resize(count);
      scratch.moments.resize(count);
      for (Index k = 0; k < count; ++k) scratch.distances[k] = distances(k);
      for (const Index k : scratch.clipper.clip(scratch.distances, scratch.moments))
        add(k, scratch.distances[k], scratch.moments[k]);
    }
  }
  chunk.energy = energy;
}

// As `integrate`, with moments that hold the density.
void CellEvaluator::integrate_weighted(Chunk& chunk, std::span<const Vec3> sites,
                                       Scratch& scratch) const {
  chunk.sums.assign(chunk.table.size(), {});
  chunk.areas.assign(chunk.table.size(), 0.0);
  double energy = 0;
  for (Index p = chunk.begin; p < chunk.end; ++p) {
    const Index* list = chunk.entries.data() + chunk.start[p - chunk.begin];
    const Index count = chunk.start[p - chunk.begin + 1] - chunk.start[p - chunk.begin];
    const std::array<Vec3, 3> v = pieces_.corners_of(p);
    const std::array<double, 3> rho = pieces_.density_of(p);
    const double area = pieces_.area[p];
    scratch.distances.resize(count);
    scratch.moments.resize(count);
    for (Index k = 0; k < count; ++k) {
      const Vec3& x = sites[chunk.table[list[k]]];
      scratch.distances[k] = {squared_distance(v[0], x), squared_distance(v[1], x),
                              squared_distance(v[2], x)};
    }
    const double inverse_density = 3 / (rho[0] + rho[1] + rho[2]);
    for (const Index k : scratch.clipper.clip(scratch.distances, rho, scratch.moments)) {
      const CornerDistances& d = scratch.distances[k];
      const Moments& m = scratch.moments[k];
      const Moments w{area * m[0], area * m[1], area * m[2]};
      const double mass = w[0] + w[1] + w[2];
      CellSums& s = chunk.sums[list[k]];
      s.mass += mass;
      s.moment += w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
      chunk.areas[list[k]] += mass * inverse_density;
      energy += w[0] * d[0] + w[1] * d[1] + w[2] * d[2];
    }
  }
  chunk.energy = energy;
}

void CellEvaluator::sum_chunks(std::span<const Vec3> sites, CellIntegrals& out) const {
  out.energy = -flat_energy_;
  out.mass.assign(sites.size(), 0.0);
  out.centroid.assign(sites.size(), Vec3{});
  const bool uniform = pieces_.uniform();
  out.expected_mass.assign(uniform ? 0 : sites.size(), 0.0);
  for (const auto& chunk : chunks_) {
    out.energy += chunk->energy;
    for (std::size_t k = 0; k < chunk->table.size(); ++k) {
      out.mass[chunk->table[k]] += chunk->sums[k].mass;
      out.centroid[chunk->table[k]] += chunk->sums[k].moment;
      if (!uniform) out.expected_mass[chunk->table[k]] += chunk->areas[k];
    }
  }
  // A cell of no area, or of rounding's alone, has no centroid.
  const double least = 1e-14 * pieces_.spacing * pieces_.spacing;
  // A cell of the right size has area 1/sqrt(rho), in units of the mean cell.
  const double mean_cell = 0.5 * std::sqrt(3.0) * pieces_.spacing * pieces_.spacing;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (!uniform && out.expected_mass[i] > 0)
      out.expected_mass[i] = mean_cell * std::sqrt(out.mass[i] / out.expected_mass[i]);
    if (out.mass[i] > least)
      out.centroid[i] = out.centroid[i] / out.mass[i];
    else
      out.centroid[i] = sites[i];
  }
}

std::vector<CellPart> CellEvaluator::parts_of(std::span<const char> wanted) const {
  std::vector<CellPart> parts;
  std::vector<CornerDistances> distances;
  std::vector<Moments> moments;
  FacetClipper clipper;
  for (const auto& chunk : chunks_) {
    for (Index p = chunk->begin; p < chunk->end; ++p) {
      const Index* list = chunk->entries.data() + chunk->start[p - chunk->begin];
      const Index count = chunk->start[p - chunk->begin + 1] - chunk->start[p - chunk->begin];
      const auto site = [&](Index k) { return chunk->table[list[k]]; };
      bool any = false;
      for (Index k = 0; k < count; ++k) any |= wanted[site(k)] != 0;
      if (!any) continue;
      const std::array<Vec3, 3> v = pieces_.corners_of(p);
      distances.resize(count);
      moments.resize(count);
      for (Index k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c) distances[k][c] = squared_distance(v[c], previous_[site(k)]);
      for (const Index k : clipper.clip(distances, moments)) {
        const Moments& m = moments[k];
        const double share = m[0] + m[1] + m[2];
        if (wanted[site(k)] != 0 && share > 0)
          parts.push_back({site(k), pieces_.area[p] * share,
                           (m[0] * v[0] + m[1] * v[1] + m[2] * v[2]) / share});
      }
    }
  }
  return parts;
}

std::vector<std::array<Index, 2>> CellEvaluator::adjacent_cells() const {
  std::vector<std::vector<std::array<Index, 2>>> of_chunk(chunks_.size());
  workers_.for_each(chunks_.size(), 1,
                    [&](std::size_t c) { of_chunk[c] = adjacent_cells(*chunks_[c]); });
  std::vector<std::array<Index, 2>> all;
  for (const auto& pairs : of_chunk) all.insert(all.end(), pairs.begin(), pairs.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

// Pairs of sites whose cells touch inside the chunk, sorted.
std::vector<std::array<Index, 2>> CellEvaluator::adjacent_cells(const Chunk& chunk) const {
  std::vector<std::array<Index, 2>> all;
  std::vector<std::array<Index, 2>> pairs;
  std::vector<CornerDistances> distances;
  FacetClipper clipper;
  for (Index p = chunk.begin; p < chunk.end; ++p) {
    const Index begin = chunk.start[p - chunk.begin];
    const Index end = chunk.start[p - chunk.begin + 1];
    if (end - begin < 2) continue;
    const std::array<Vec3, 3> v = pieces_.corners_of(p);
    distances.clear();
    for (Index e = begin; e < end; ++e) {
      const Vec3& x = previous_[chunk.table[chunk.entries[e]]];
      distances.push_back(
          {squared_distance(v[0], x), squared_distance(v[1], x), squared_distance(v[2], x)});
    }
    pairs.clear();
    clipper.adjacent(distances, pairs);
    for (const auto& [i, j] : pairs)
      all.push_back({chunk.table[chunk.entries[begin + i]], chunk.table[chunk.entries[begin + j]]});
  }
  for (auto& pair : all) std::sort(pair.begin(), pair.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace nonobtuse::rvd
