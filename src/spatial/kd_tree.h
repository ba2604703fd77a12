// Nearest sites by a kd-tree.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::spatial {

/// Holds a copy of the sites. Queries are thread-safe; among sites at equal distance the one of
/// lower index comes first. Coordinates must be below 1e150 in size.
class NearestSites {
 public:
  struct Neighbor {
    Index site = -1;
    double squared_distance = std::numeric_limits<double>::infinity();
  };

  /// O(n log n).
  explicit NearestSites(std::span<const Vec3> sites);
  ~NearestSites();
  NearestSites(NearestSites&&) noexcept;
  NearestSites& operator=(NearestSites&&) noexcept;

  /// The nearest site; `site` is -1 if there is none.
  [[nodiscard]] Neighbor nearest(const Vec3& p) const;
  /// The k nearest sites (all, if there are fewer), nearest first; `out` is overwritten.
  void nearest(const Vec3& p, Index k, std::vector<Neighbor>& out) const;
  /// All sites at most `radius` away, nearest first; `out` is overwritten.
  void within(const Vec3& p, double radius, std::vector<Neighbor>& out) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace nonobtuse::spatial
