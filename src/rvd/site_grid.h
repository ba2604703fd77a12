// Sites in a hashed uniform grid: linear memory for any shape. Rebuilt at every evaluation, since
// a counting sort costs far less than one evaluation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "numeric/vec3.h"
#include "spatial/box.h"

namespace nonobtuse::rvd {

class SiteGrid {
 public:
  /// `sites` must stay alive and unchanged; finite. `cell` > 0: edge of a grid cell.
  void build(std::span<const Vec3> sites, double cell);

  /// Appends every site inside the closed box, in an order that depends on the sites alone.
  void gather(const spatial::Box& box, std::vector<Index>& out) const;

  /// The site nearest to p, ties to the lowest index. `hint`: any site, the nearer the faster.
  [[nodiscard]] Index nearest(const Vec3& p, Index hint) const;

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct Entry {
    Vec3 point;
    std::uint64_t key;  // of the cell
    Index site;
  };
  [[nodiscard]] Cell cell_of(const Vec3& p) const;
  [[nodiscard]] std::size_t bucket_of(std::uint64_t key) const;
  void improve(const Vec3& p, const Cell& c, double& best, Index& site) const;

  std::span<const Vec3> sites_;
  double inverse_cell_ = 1;
  double cell_ = 1;
  Vec3 origin_;
  std::size_t mask_ = 0;
  std::vector<Index> start_;    // #buckets + 1
  std::vector<Entry> entries_;  // by bucket, then by index
};

}  // namespace nonobtuse::rvd
