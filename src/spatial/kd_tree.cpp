// nanoflann (Blanco & Rai 2014) does the searching; its own result sets break ties by the order of
// the search, so ours compare (distance, index), and accept a branch at equal distance.
#include "spatial/kd_tree.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace nonobtuse::spatial {

namespace {

using Neighbor = NearestSites::Neighbor;

bool before(const Neighbor& a, const Neighbor& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                  : a.site < b.site;
}

// nanoflann skips points and branches that are not strictly nearer than worstDist().
double just_above(double d) { return std::nextafter(d, std::numeric_limits<double>::infinity()); }

// Rounding may put a branch a little farther than the points in it.
double slack_above(double d) { return just_above(d * (1 + 0x1p-48)); }

struct Sites {
  std::vector<Vec3> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    const Vec3& p = points[i];
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// The k first by (distance, index), kept sorted.
class NearestSet {
 public:
  NearestSet(std::vector<Neighbor>& out, std::size_t k) : out_(out), k_(k) { out_.clear(); }
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] std::size_t size() const { return out_.size(); }
  [[nodiscard]] double worstDist() const {
    return out_.size() < k_ ? std::numeric_limits<double>::infinity()
                            : slack_above(out_.back().squared_distance);
  }
  bool addPoint(double squared_distance, Index site) {
    const Neighbor candidate{site, squared_distance};
    if (out_.size() == k_) {
      if (!before(candidate, out_.back())) return true;
      out_.pop_back();
    }
    out_.insert(std::upper_bound(out_.begin(), out_.end(), candidate, before), candidate);
    return true;
  }

 private:
  std::vector<Neighbor>& out_;
  std::size_t k_;
};

class RadiusSet {
 public:
  RadiusSet(std::vector<Neighbor>& out, double limit) : out_(out), limit_(limit) { out_.clear(); }
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] std::size_t size() const { return out_.size(); }
  [[nodiscard]] double worstDist() const { return slack_above(limit_); }
  bool addPoint(double squared_distance, Index site) {
    if (squared_distance <= limit_) out_.push_back({site, squared_distance});
    return true;
  }

 private:
  std::vector<Neighbor>& out_;
  double limit_;
};

}  // namespace

struct NearestSites::Tree {
  using Nanoflann =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Sites, double>,
                                          Sites, 3, std::uint32_t>;

  explicit Tree(std::span<const Vec3> sites)
      : points{{sites.begin(), sites.end()}},
        index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {
    index.buildIndex();
  }

  template <class Set>
  void search(const Vec3& p, Set& set) const {
    if (points.points.empty()) return;
    const double query[3] = {p.x, p.y, p.z};
    struct Adapter {
      Set& set;
      [[nodiscard]] bool full() const { return set.full(); }
      [[nodiscard]] double worstDist() const { return set.worstDist(); }
      bool addPoint(double d, std::uint32_t i) { return set.addPoint(d, static_cast<Index>(i)); }
    } adapter{set};
    index.findNeighbors(adapter, query, nanoflann::SearchParams());
  }

  Sites points;
  Nanoflann index;
};

NearestSites::NearestSites(std::span<const Vec3> sites) : tree_(std::make_unique<Tree>(sites)) {}
NearestSites::~NearestSites() = default;
NearestSites::NearestSites(NearestSites&&) noexcept = default;
NearestSites& NearestSites::operator=(NearestSites&&) noexcept = default;

Neighbor NearestSites::nearest(const Vec3& p) const {
  std::vector<Neighbor> out;
  nearest(p, 1, out);
  return out.empty() ? Neighbor{} : out[0];
}

void NearestSites::nearest(const Vec3& p, Index k, std::vector<Neighbor>& out) const {
  out.clear();
  if (k <= 0) return;
  NearestSet set(out, static_cast<std::size_t>(k));
  tree_->search(p, set);
}

void NearestSites::within(const Vec3& p, double radius, std::vector<Neighbor>& out) const {
  RadiusSet set(out, radius * radius);
  tree_->search(p, set);
  std::sort(out.begin(), out.end(), before);
}

}  // namespace nonobtuse::spatial
