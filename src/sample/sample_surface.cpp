// A sphere shell with four round windows in the directions of a tetrahedron, genus 3, polygonised
// by marching cubes (Lorensen & Cline 1987). Polynomial and interpolated by the four operations
// alone, so the same bytes everywhere.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "nonobtuse/error.h"
#include "nonobtuse/sample.h"
#include "sample/marching_cubes_table.h"

namespace nonobtuse {
namespace {

// (r^2 - 1)^2 is 0 on the unit sphere; xyz is largest in the directions of the windows, where the
// shell closes before it reaches them, and smallest in the opposite ones, where it is thickest.
double implicit_function(double x, double y, double z) {
  constexpr double kThickness = 0.15;
  constexpr double kWindow = 1.6;
  const double s = x * x + y * y + z * z - 1;
  return s * s + kWindow * (x * y * z) - kThickness;
}

constexpr double kHalfWidth = 1.25;  // the surface lies inside [-1.2, 1.2]^3

class Polygonizer {
 public:
  explicit Polygonizer(Index resolution)
      : cells_(static_cast<std::size_t>(resolution)),
        nodes_(cells_ + 1),
        table_(sample::marching_cubes_table()) {
    for (std::size_t side = 0; side < 2; ++side) {
      values_[side].resize(nodes_ * nodes_);
      for (auto& ids : vertex_ids_[side]) ids.assign(nodes_ * nodes_, -1);
    }
  }

  TriangleMesh run() {
    evaluate(0);
    for (std::size_t k = 0; k < cells_; ++k) {
      evaluate(k + 1);
      for (std::size_t j = 0; j < cells_; ++j)
        for (std::size_t i = 0; i < cells_; ++i) polygonize_cell(i, j, k);
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] double coordinate(std::size_t node) const {
    return kHalfWidth * (2 * static_cast<double>(node) / static_cast<double>(cells_) - 1);
  }

  // Two layers of nodes are enough; layer k lives in slot k % 2.
  void evaluate(std::size_t k) {
    for (std::size_t j = 0; j < nodes_; ++j)
      for (std::size_t i = 0; i < nodes_; ++i)
        values_[k % 2][j * nodes_ + i] =
            implicit_function(coordinate(i), coordinate(j), coordinate(k));
    for (auto& ids : vertex_ids_[k % 2]) std::fill(ids.begin(), ids.end(), -1);
  }

  [[nodiscard]] double value(const std::array<std::size_t, 3>& node) const {
    return values_[node[2] % 2][node[1] * nodes_ + node[0]];
  }

  void polygonize_cell(std::size_t i, std::size_t j, std::size_t k) {
    std::size_t signs = 0;
    for (std::size_t c = 0; c < 8; ++c)
      if (value({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)}) < 0)
        signs |= std::size_t{1} << c;
    for (const std::array<int, 3>& edges : table_[signs]) {
      Triangle triangle{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const sample::CellEdge& edge =
            sample::cell_edges()[static_cast<std::size_t>(edges[corner])];
        const auto c = static_cast<std::size_t>(edge.corner);
        triangle[corner] = vertex({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)},
                                  static_cast<std::size_t>(edge.axis));
      }
      mesh_.triangles.push_back(triangle);
    }
  }

  // The vertex on the grid edge that starts at `node`, made when it is first asked for.
  Index vertex(const std::array<std::size_t, 3>& node, std::size_t axis) {
    Index& id = vertex_ids_[node[2] % 2][axis][node[1] * nodes_ + node[0]];
    if (id >= 0) return id;
    std::array<std::size_t, 3> other = node;
    ++other[axis];
    const double from = value(node);
    // Kept off the nodes, where the vertices of several edges would coincide.
    const double t = std::clamp(from / (from - value(other)), 1e-3, 1 - 1e-3);
    std::array<double, 3> p{coordinate(node[0]), coordinate(node[1]), coordinate(node[2])};
    p[axis] += t * (coordinate(other[axis]) - p[axis]);
    id = static_cast<Index>(mesh_.vertices.size());
    mesh_.vertices.push_back({p[0], p[1], p[2]});
    return id;
  }

  std::size_t cells_;
  std::size_t nodes_;
  std::array<sample::CellTriangles, 256> table_;
  std::array<std::vector<double>, 2> values_;
  std::array<std::array<std::vector<Index>, 3>, 2> vertex_ids_;  // per slot and axis
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh sample_surface(Index resolution) {
  if (resolution < 16 || resolution > 1024)
    throw InvalidInput("The resolution of the sample surface must be between 16 and 1024, not " +
                       std::to_string(resolution) + ".");
  return Polygonizer(resolution).run();
}

}  // namespace nonobtuse
