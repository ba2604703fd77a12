// After the jumping of seeds between cells in vector quantisation (Patane, Russo, The enhanced LBG
// algorithm, 2001), with masses in place of distortions. A cell is split by means of its own parts
// (Lloyd 1982), which lie on the surface.
#include "remesh/mass_balance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nonobtuse::pipeline {
namespace {

constexpr double kHeavy = 1.5;  // times the mean mass
constexpr int kRounds = 4;      // of means

// A cell to be split among the sites `into`, its own first.
struct Split {
  std::vector<Index> into;
  std::vector<rvd::CellPart> parts;
};

// Index of the center nearest to p.
std::size_t nearest(const std::vector<Vec3>& centers, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < centers.size(); ++k)
    if (squared_distance(centers[k], p) < squared_distance(centers[best], p)) best = k;
  return best;
}

// k points spread over the parts: the two that are far apart, then what is farthest of all so far,
// then their means.
std::vector<Vec3> means(const std::vector<rvd::CellPart>& parts, std::size_t k) {
  const auto farthest = [&](const std::vector<Vec3>& centers) {
    std::size_t best = 0;
    double distance = -1;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Vec3& p = parts[i].centroid;
      const double d = squared_distance(centers[nearest(centers, p)], p);
      if (d > distance) distance = d, best = i;
    }
    return parts[best].centroid;
  };
  std::vector<Vec3> centers{farthest({parts.front().centroid})};
  while (centers.size() < k) centers.push_back(farthest(centers));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vec3> moment(k);
    std::vector<double> mass(k, 0);
    for (const rvd::CellPart& part : parts) {
      const std::size_t c = nearest(centers, part.centroid);
      moment[c] += part.mass * part.centroid;
      mass[c] += part.mass;
    }
    for (std::size_t c = 0; c < k; ++c)
      if (mass[c] > 0) centers[c] = moment[c] / mass[c];
  }
  return centers;
}

// Which cells are split among which sites, of one component; `order` has the lightest first.
void plan(const std::vector<double>& mass, const std::vector<Index>& order,
          std::vector<Split>& splits) {
  double total = 0;
  for (const Index i : order) total += mass[i];
  const double mean = total / static_cast<double>(order.size());
  std::size_t taken = 0;
  for (std::size_t heaviest = order.size(); heaviest-- > 0;) {
    const Index i = order[heaviest];
    if (!(mass[i] > kHeavy * mean)) return;
    const int more = std::max(1, static_cast<int>(std::round(mass[i] / mean)) - 1);
    Split split{{i}, {}};
    for (int k = 0; k < more && mass[order[taken]] <= mean; ++k)
      split.into.push_back(order[taken++]);
    if (split.into.size() == 1) return;
    splits.push_back(std::move(split));
  }
}

}  // namespace

Index balance_masses(rvd::CellEvaluator& evaluator, std::span<const Index> component,
                     std::vector<Vec3>& sites) {
  rvd::CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  std::vector<Index> order(sites.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return component[a] != component[b] ? component[a] < component[b]
                                        : cells.mass[a] < cells.mass[b];
  });
  std::vector<Split> splits;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && component[order[end]] == component[order[begin]]) ++end;
    plan(cells.mass,
         {order.begin() + static_cast<std::ptrdiff_t>(begin),
          order.begin() + static_cast<std::ptrdiff_t>(end)},
         splits);
  }
  std::vector<char> wanted(sites.size(), 0);
  std::vector<Index> split_of(sites.size(), -1);
  for (std::size_t s = 0; s < splits.size(); ++s) {
    wanted[splits[s].into.front()] = 1;
    split_of[splits[s].into.front()] = static_cast<Index>(s);
  }
  for (const rvd::CellPart& part : evaluator.parts_of(wanted))
    splits[split_of[part.site]].parts.push_back(part);
  Index moved = 0;
  for (const Split& split : splits) {
    const std::vector<Vec3> centers = means(split.parts, split.into.size());
    for (std::size_t k = 0; k < centers.size(); ++k) sites[split.into[k]] = centers[k];
    moved += static_cast<Index>(centers.size()) - 1;
  }
  return moved;
}

}  // namespace nonobtuse::pipeline
