// Binned surface area heuristic (Wald 2007), top down, on the axis along which the centres spread
// most; below a depth at which it must have gone wrong, halves.
#include "spatial/triangle_bvh.h"

#include <algorithm>
#include <cmath>

namespace nonobtuse::spatial {

class TriangleBvhBuilder {
 public:
  TriangleBvhBuilder(TriangleBvh& bvh, std::span<const Vec3> vertices,
                     std::span<const Triangle> triangles, const parallel::Workers& workers)
      : bvh_(bvh), workers_(workers), items_(triangles.size()) {
    workers.for_each(triangles.size(), 4096, [&](std::size_t t) {
      Item& item = items_[t];
      for (const Index v : triangles[t]) item.box.add(vertices[v]);
      item.center = 0.5 * item.box.low + 0.5 * item.box.high;
      item.triangle = static_cast<Index>(t);
    });
  }

  void build() {
    const Index count = static_cast<Index>(items_.size());
    Box box;
    for (const Item& item : items_) box.add(item.box);
    margin_ = margin_of(box);
    // The top level by level, then what hangs below in parallel. A node's place in memory depends
    // on the mesh alone.
    std::vector<Node>& nodes = bvh_.nodes_;
    nodes.reserve(items_.size());
    nodes.emplace_back();
    std::vector<Task> tasks{{0, 0, count, 0}};
    while (!tasks.empty() && tasks.size() < kSubtrees && count > kSerial) {
      std::vector<Index> middle(tasks.size());
      workers_.for_each(tasks.size(), 1,
                        [&](std::size_t i) { middle[i] = make_node(tasks[i], nodes); });
      std::vector<Task> below;
      for (std::size_t i = 0; i < tasks.size(); ++i)
        if (middle[i] != tasks[i].begin) add_children(tasks[i], middle[i], nodes, below);
      tasks.swap(below);
    }
    std::vector<std::vector<Node>> subtrees(tasks.size());
    workers_.for_each(tasks.size(), 1,
                      [&](std::size_t i) { subtrees[i] = build_subtree(tasks[i]); });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      // A subtree's root has its place already; its other nodes follow at the end.
      const Index shift = static_cast<Index>(nodes.size()) - 1;
      for (Node& node : subtrees[i])
        if (node.count == 0) node.first += shift;
      nodes[tasks[i].node] = subtrees[i].front();
      nodes.insert(nodes.end(), subtrees[i].begin() + 1, subtrees[i].end());
    }
    bvh_.order_.reserve(items_.size());
    for (const Item& item : items_) bvh_.order_.push_back(item.triangle);
  }

 private:
  struct Item {
    Box box;
    Vec3 center;
    Index triangle = -1;
  };
  struct Task {
    Index node, begin, end;
    int depth;
  };
  using Node = TriangleBvh::Node;
  static constexpr std::size_t kSubtrees = 32;
  static constexpr Index kSerial = 2048;  // triangles that are not worth the threads
  static constexpr int kBins = 16;
  static constexpr int kLeaf = 4;
  static constexpr int kHalveBelow = 48;     // 48 + 31 halvings + 1 < TriangleBvh::kMaxDepth
  static constexpr double kTraversal = 0.5;  // cost of a node over that of a triangle

  static Vec3 margin_of(const Box& box) {
    const Vec3 largest = max(max(box.low, -box.low), max(box.high, -box.high));
    const double m = 0x1p-48 * std::max({largest.x, largest.y, largest.z});
    return {m, m, m};
  }

  static double along(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

  // Fills the task's node; returns where its items are parted, or its begin for a leaf.
  Index make_node(const Task& task, std::vector<Node>& nodes) {
    Box box;
    Box centers;
    for (Index i = task.begin; i < task.end; ++i) {
      box.add(items_[i].box);
      centers.add(items_[i].center);
    }
    nodes[task.node].box = {box.low - margin_, box.high + margin_};
    const Index middle = split(task, box, centers);
    if (middle == task.begin) {
      nodes[task.node].first = task.begin;
      nodes[task.node].count = task.end - task.begin;
    }
    return middle;
  }

  static void add_children(const Task& task, Index middle, std::vector<Node>& nodes,
                           std::vector<Task>& tasks) {
    const Index child = static_cast<Index>(nodes.size());
    nodes[task.node].first = child;
    nodes.resize(nodes.size() + 2);
    tasks.push_back({child + 1, middle, task.end, task.depth + 1});
    tasks.push_back({child, task.begin, middle, task.depth + 1});
  }

  std::vector<Node> build_subtree(const Task& root) {
    std::vector<Node> nodes(1);
    nodes.reserve(root.end - root.begin);
    std::vector<Task> tasks{{0, root.begin, root.end, root.depth}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const Index middle = make_node(task, nodes);
      if (middle != task.begin) add_children(task, middle, nodes, tasks);
    }
    return nodes;
  }

  // Parts items [begin, end) and returns the first of the second part; `begin` asks for a leaf.
  Index split(const Task& task, const Box& box, const Box& centers) {
    const Index count = task.end - task.begin;
    if (count <= 2) return task.begin;
    const Vec3 extent = centers.high - centers.low;
    const int axis =
        extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const double width = along(extent, axis);
    if (!(width > 0) || task.depth >= kHalveBelow) {
      if (count <= kLeaf) return task.begin;
      return halve(task, axis);
    }
    const double low = along(centers.low, axis);
    const auto bin_of = [&](const Item& item) {
      const double f = (along(item.center, axis) - low) / width;  // in [0, 1]
      return std::min(kBins - 1, static_cast<int>(f * kBins));
    };
    std::array<Box, kBins> boxes;
    std::array<Index, kBins> counts{};
    for (Index i = task.begin; i < task.end; ++i) {
      const int b = bin_of(items_[i]);
      boxes[b].add(items_[i].box);
      ++counts[b];
    }
    const auto [bin, cost] = best_bin(boxes, counts, box.half_area());
    if (count <= kLeaf && cost >= count) return task.begin;
    if (bin < 0) return halve(task, axis);
    const auto middle =
        std::partition(items_.begin() + task.begin, items_.begin() + task.end,
                       [&, last = bin](const Item& item) { return bin_of(item) <= last; });
    return static_cast<Index>(middle - items_.begin());
  }

  // The last bin of the cheaper side's split, and its expected cost in triangles.
  static std::pair<int, double> best_bin(const std::array<Box, kBins>& boxes,
                                         const std::array<Index, kBins>& counts, double area) {
    std::array<double, kBins> right{};  // cost of bins b + 1 ...
    Box box;
    Index n = 0;
    for (int b = kBins - 1; b > 0; --b) {
      box.add(boxes[b]);
      n += counts[b];
      right[b - 1] = n > 0 ? n * box.half_area() : -1;
    }
    box = {};
    n = 0;
    int best = -1;
    double best_cost = std::numeric_limits<double>::infinity();
    for (int b = 0; b + 1 < kBins; ++b) {
      box.add(boxes[b]);
      n += counts[b];
      if (n == 0 || right[b] < 0) continue;
      const double cost = n * box.half_area() + right[b];
      if (cost < best_cost) {
        best_cost = cost;
        best = b;
      }
    }
    return {best, area > 0 ? kTraversal + best_cost / area : best_cost};
  }

  Index halve(const Task& task, int axis) {
    const Index middle = task.begin + (task.end - task.begin) / 2;
    std::nth_element(items_.begin() + task.begin, items_.begin() + middle,
                     items_.begin() + task.end, [axis](const Item& a, const Item& b) {
                       const double x = along(a.center, axis);
                       const double y = along(b.center, axis);
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
    return middle;
  }

  TriangleBvh& bvh_;
  const parallel::Workers& workers_;
  std::vector<Item> items_;
  Vec3 margin_;
};

TriangleBvh::TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                         const parallel::Workers& workers) {
  if (triangles.empty()) return;
  TriangleBvhBuilder(*this, vertices, triangles, workers).build();
  corners_.resize(order_.size());
  workers.for_each(order_.size(), 4096, [&](std::size_t i) {
    const Triangle& t = triangles[order_[i]];
    corners_[i] = {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  });
}

TriangleBvh::Hit TriangleBvh::closest(const Vec3& p, double limit) const {
  return closest_if(p, limit, [](Index) { return true; });
}

}  // namespace nonobtuse::spatial
