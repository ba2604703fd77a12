// A triangulation with V interior and m boundary vertices has 2 V + m - 2 x triangles, by Euler's
// formula.
#include "features/vertex_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nonobtuse/error.h"

namespace nonobtuse::features {

namespace {

class Balancer {
 public:
  Balancer(const std::vector<CurveDemand>& curves, const std::vector<PatchDemand>& patches,
           Index corners)
      : curves_(curves), patches_(patches), corners_(corners) {}

  // Segments of all curves for edges of length h; `h` infinite: the least.
  [[nodiscard]] std::vector<Index> segments(double h) const {
    std::vector<Index> result;
    for (const CurveDemand& c : curves_) {
      if (c.fixed > 0) {
        result.push_back(c.fixed);
        continue;
      }
      const double wanted = std::min(std::round(c.length / (kCurveSpacing * h)), 1e9);
      result.push_back(std::max(c.least, static_cast<Index>(wanted)));
    }
    return result;
  }

  [[nodiscard]] Index vertices_on_curves(const std::vector<Index>& segments) const {
    Index sum = corners_;
    for (std::size_t c = 0; c < curves_.size(); ++c)
      sum += segments[c] - (curves_[c].closed ? 0 : 1);
    return sum;
  }

  // Interior vertices that the patches ask for, unrounded.
  [[nodiscard]] std::vector<double> interior(double h, const std::vector<Index>& segments) const {
    std::vector<double> wanted(patches_.size());
    for (std::size_t p = 0; p < patches_.size(); ++p)
      wanted[p] = patches_[p].area * 2 / (std::sqrt(3.0) * h * h) + patches_[p].euler;
    for (std::size_t c = 0; c < curves_.size(); ++c)
      for (const Index p : curves_[c].patches) wanted[p] -= 0.5 * segments[c];
    for (std::size_t p = 0; p < patches_.size(); ++p)
      wanted[p] = std::max<double>(wanted[p], patches_[p].least);
    return wanted;
  }

  [[nodiscard]] double total(double h) const {
    const std::vector<Index> s = segments(h);
    const std::vector<double> v = interior(h, s);
    return vertices_on_curves(s) + std::accumulate(v.begin(), v.end(), 0.0);
  }

  [[nodiscard]] Index least() const {
    Counts counts = least_counts();
    return counts.on_curves + counts.interior;
  }

  VertexBalance run(Index n) const {
    if (least() > n)
      throw TooFewVertices(
          fmt::format("{} vertices are too few for the features of this surface; {} are enough.", n,
                      least()),
          least());
    // The largest h for which there are not too few; the counts are then fitted to n.
    double area = 0;
    for (const PatchDemand& p : patches_) area += p.area;
    double low = 1e-3 * std::sqrt(area / n);
    double high = 1e4 * std::sqrt(area / n);
    for (int step = 0; step < 100; ++step) {
      const double middle = std::sqrt(low * high);
      (total(middle) > n ? low : high) = middle;
    }
    VertexBalance result{high, segments(high), {}};
    const Index left = n - vertices_on_curves(result.segments);
    result.interior = share(interior(high, result.segments), left);
    return result;
  }

 private:
  struct Counts {
    Index on_curves = 0;
    Index interior = 0;
  };
  [[nodiscard]] Counts least_counts() const {
    Counts counts;
    std::vector<Index> fewest;
    for (const CurveDemand& c : curves_) fewest.push_back(c.fixed > 0 ? c.fixed : c.least);
    counts.on_curves = vertices_on_curves(fewest);
    for (const PatchDemand& p : patches_) counts.interior += p.least;
    return counts;
  }

  // Whole numbers near the wanted ones, none below its least, with the given sum; largest
  // remainders first, and what is over or missing goes to the largest patches.
  [[nodiscard]] std::vector<Index> share(const std::vector<double>& wanted, Index sum) const {
    double least = 0, above = 0;
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      least += patches_[p].least;
      above += wanted[p] - patches_[p].least;
    }
    const double scale = above > 0 ? (sum - least) / above : 0;
    std::vector<Index> given(wanted.size());
    std::vector<double> remainder(wanted.size());
    Index left = sum;
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      const double share = patches_[p].least + scale * (wanted[p] - patches_[p].least);
      given[p] = std::max(patches_[p].least, static_cast<Index>(std::floor(share)));
      remainder[p] = share - given[p];
      left -= given[p];
    }
    std::vector<Index> order(wanted.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      return remainder[a] != remainder[b] ? remainder[a] > remainder[b]
                                          : patches_[a].area > patches_[b].area;
    });
    for (std::size_t k = 0; left > 0; k = (k + 1) % order.size(), --left) ++given[order[k]];
    for (std::size_t k = order.size(); left < 0;) {
      k = k == 0 ? order.size() - 1 : k - 1;
      if (given[order[k]] > patches_[order[k]].least) --given[order[k]], ++left;
    }
    return given;
  }

  const std::vector<CurveDemand>& curves_;
  const std::vector<PatchDemand>& patches_;
  Index corners_;
};

}  // namespace

VertexBalance balance_vertices(const std::vector<CurveDemand>& curves,
                               const std::vector<PatchDemand>& patches, Index corners, Index n) {
  return Balancer(curves, patches, corners).run(n);
}

}  // namespace nonobtuse::features
