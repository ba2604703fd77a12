// From what a file holds to oriented surfaces without degenerate faces, which may meet along edges
// and in vertices: repairs that leave no doubt are made and reported, everything else is refused
// with its place.
#include "mesh/cleaning.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/cut.h"
#include "mesh/degenerate_faces.h"
#include "mesh/topology.h"
#include "nonobtuse/io.h"
#include "numeric/vec3.h"

namespace nonobtuse {

namespace {

std::string number(Index i) { return std::to_string(i); }

// Ranges and numbers before anything else, so that nothing below can fail on them.
void check_elements(const TriangleMesh& mesh) {
  const auto count = static_cast<Index>(mesh.vertices.size());
  for (Index v = 0; v < count; ++v)
    if (!is_finite(mesh.vertices[v]))
      throw InvalidInput(
          "Vertex " + number(v) + " has a coordinate that is not finite; repair or remove it.", v);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t])
      if (v < 0 || v >= count)
        throw InvalidInput("Triangle " + std::to_string(t) + " names vertex " + number(v) +
                               ", but there are " + number(count) + " vertices, counted from 0.",
                           static_cast<Index>(t));
  if (mesh.triangles.empty()) throw InvalidInput("The mesh has no triangles.");
}

// Whether every vertex is used and its triangles form one fan around it.
bool one_fan_each(const TriangleMesh& mesh, const std::vector<std::array<Index, 3>>& adjacent) {
  const auto corner_of = [&](Index t, Index v) {
    const Triangle& f = mesh.triangles[t];
    return f[0] == v ? 0 : f[1] == v ? 1 : 2;
  };
  std::vector<Index> corners(mesh.vertices.size(), 0);
  std::vector<Index> some(mesh.vertices.size(), -1);  // at a boundary the last clockwise
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.triangles[t][k];
      ++corners[v];
      if (some[v] < 0 || adjacent[t][mesh::previous(k)] < 0) some[v] = t;
    }
  for (Index v = 0; v < static_cast<Index>(mesh.vertices.size()); ++v) {
    if (some[v] < 0) return false;
    Index met = 0;
    Index t = some[v];
    do {
      ++met;
      t = adjacent[t][mesh::next(corner_of(t, v))];
    } while (t >= 0 && t != some[v] && met <= corners[v]);
    if (met != corners[v]) return false;
  }
  return true;
}

class Cleaner {
 public:
  explicit Cleaner(const TriangleMesh& mesh)
      : mesh_(mesh), source_(mesh.triangles.size()), original_(mesh.vertices.size()) {
    std::iota(source_.begin(), source_.end(), Index{0});
    std::iota(original_.begin(), original_.end(), Index{0});
  }

  CleanResult run() {
    drop_repeated_vertices();
    drop_duplicates();
    drop_degenerate_at_crowded_edges();
    refuse_nothing_left();
    report_unused_vertices();
    part();
    orient();
    // Dropping faces may leave fans that touch in a point; parted, they are manifolds again.
    while (remove_degenerate()) part();
    refuse_nothing_left();
    join();
    drop_unused_vertices();
    report_kept();
    CleanResult result;
    result.mesh = std::move(mesh_);
    result.repairs = std::move(repairs_);
    result.kept = std::move(kept_);
    result.source_triangle = std::move(source_);
    result.source_vertex = std::move(original_);
    return result;
  }

 private:
  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(mesh_.vertices.size()); }
  [[nodiscard]] bool has_no_area(Index t) const {
    const Triangle& f = mesh_.triangles[t];
    return mesh::collinear(mesh_.vertices[f[0]], mesh_.vertices[f[1]], mesh_.vertices[f[2]]);
  }

  void report(const std::string& what, Index count, Index first) {
    if (count > 0) repairs_.push_back({what, count, first});
  }

  // Keeps the triangles that are not marked, in order, with their numbers in the input.
  void drop(const std::vector<char>& marked, const std::string& what) {
    Index kept = 0;
    Index first = -1;
    for (std::size_t t = 0; t < marked.size(); ++t) {
      if (marked[t] != 0) {
        if (first < 0) first = source_[t];
        continue;
      }
      mesh_.triangles[kept] = mesh_.triangles[t];
      source_[kept++] = source_[t];
    }
    report(what, static_cast<Index>(marked.size()) - kept, first);
    mesh_.triangles.resize(kept);
    source_.resize(kept);
  }

  void drop_repeated_vertices() {
    std::vector<char> marked(mesh_.triangles.size(), 0);
    for (std::size_t t = 0; t < marked.size(); ++t) {
      const Triangle& f = mesh_.triangles[t];
      marked[t] = f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
    }
    drop(marked, "faces that name a vertex twice dropped");
  }

  void drop_duplicates() {
    std::vector<std::pair<Triangle, Index>> sorted(mesh_.triangles.size());
    for (std::size_t t = 0; t < sorted.size(); ++t) {
      Triangle f = mesh_.triangles[t];
      std::sort(f.begin(), f.end());
      sorted[t] = {f, static_cast<Index>(t)};
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> marked(mesh_.triangles.size(), 0);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first != sorted[i - 1].first) continue;
      const Index t = sorted[i].second;
      const Index before = sorted[i - 1].second;
      if (has_no_area(t))
        marked[t] = marked[before] = 1;  // a pocket between two needles, or copies of one
      else if (same_turn(mesh_.triangles[t], mesh_.triangles[before]))
        marked[t] = 1;
      else
        throw InvalidInput("Triangles " + number(source_[before]) + " and " + number(source_[t]) +
                               " have the same three vertices in opposite order; delete one of "
                               "them or both.",
                           source_[t]);
    }
    drop(marked, "duplicate faces dropped");
  }

  // Whether two triangles of the same vertices have the same orientation.
  static bool same_turn(const Triangle& a, const Triangle& b) {
    const auto k = std::find(b.begin(), b.end(), a[0]) - b.begin();
    return b[(k + 1) % 3] == a[1];
  }

  // A face without area is no reason to refuse an edge that it shares with two others.
  void drop_degenerate_at_crowded_edges() {
    std::vector<char> marked(mesh_.triangles.size(), 0);
    mesh::for_each_edge(mesh::edge_sides(mesh_.triangles, vertex_count()),
                        [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
                          if (last - first <= 2) return;
                          for (const mesh::EdgeSide* s = first; s != last; ++s)
                            if (has_no_area(s->triangle)) marked[s->triangle] = 1;
                        });
    drop(marked, "faces without area dropped at edges of three or more faces");
  }

  void refuse_nothing_left() const {
    if (mesh_.triangles.empty())
      throw InvalidInput("Every triangle is degenerate: there is no surface.", 0);
  }

  // Patches that meet along edges of three or more faces, and fans that touch in a vertex, get
  // copies of their common vertices: each is then a manifold, to be oriented and mended by itself.
  void part() {
    mesh::Cut cut = mesh::cut_to_manifold(mesh_.triangles, vertex_count(),
                                          mesh::edge_sides(mesh_.triangles, vertex_count()));
    mesh_.triangles = std::move(cut.triangles);
    for (std::size_t v = original_.size(); v < cut.original.size(); ++v) {
      original_.push_back(original_[cut.original[v]]);
      mesh_.vertices.push_back(mesh_.vertices[cut.original[v]]);
    }
  }

  // Undoes `part`.
  void join() {
    for (Triangle& t : mesh_.triangles)
      for (Index& v : t) v = original_[v];
    drop_repeated_vertices();
  }

  // What is no repair but good to know: where the surface is no manifold.
  void report_kept() {
    const auto sides = mesh::edge_sides(mesh_.triangles, vertex_count());
    Index crowded = 0;
    Index first_crowded = -1;
    std::vector<char> seen(mesh_.vertices.size(), 0);
    mesh::for_each_edge(sides, [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
      if (last - first <= 2) return;
      if (crowded++ == 0) first_crowded = first->triangle;
      seen[first->low] = seen[first->high] = 1;
    });
    Index touching = 0;
    Index first_touching = -1;
    const mesh::Cut cut = mesh::cut_to_manifold(mesh_.triangles, vertex_count(), sides);
    for (std::size_t v = mesh_.vertices.size(); v < cut.original.size(); ++v) {
      const Index w = cut.original[v];
      if (seen[w]++ != 0) continue;
      ++touching;
      if (first_touching < 0 || w < first_touching) first_touching = w;
    }
    if (crowded > 0)
      kept_.push_back({"edges of three or more faces kept as curves where patches meet", crowded,
                       first_crowded});
    if (touching > 0)
      kept_.push_back(
          {"vertices where several fans of faces touch kept as points", touching, first_touching});
  }

  void orient() {
    const mesh::Orientation orientation = mesh::consistent_orientation(
        mesh_.triangles.size(), mesh::edge_sides(mesh_.triangles, vertex_count()));
    if (orientation.contradiction >= 0)
      throw InvalidInput("The surface has one side only, as a Moebius strip: around triangle " +
                             number(source_[orientation.contradiction]) +
                             " no orientation fits; cut the surface open.",
                         source_[orientation.contradiction]);
    if (orientation.count == 0) return;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (orientation.turned[t] != 0) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    report("faces turned to agree with their neighbours", orientation.count,
           source_[orientation.first]);
  }

  // Returns whether there were any.
  bool remove_degenerate() {
    Index first = -1;
    for (std::size_t t = mesh_.triangles.size(); t-- > 0;)
      if (has_no_area(static_cast<Index>(t))) first = source_[t];
    if (first < 0) return false;
    const std::vector<Triangle> before = mesh_.triangles;
    const mesh::DegenerateRemoval removal = mesh::remove_degenerate_faces(mesh_);
    renew_sources(before);
    report("faces without area removed by flipping their longest edge", removal.flipped, first);
    report("vertices merged to remove faces without area", removal.collapsed, first);
    report("faces without area dropped", removal.dropped - removal.opened, first);
    report("faces without area dropped that leave a slit", removal.opened, first);
    return true;
  }

  // After edits: the sources of triangles by their vertices; a new one takes that of a face that it
  // shares an edge with, one with an area if there is any.
  void renew_sources(const std::vector<Triangle>& before) {
    const std::vector<Index> sources = std::move(source_);
    source_.clear();
    const auto sorted = [](Triangle t) {
      std::sort(t.begin(), t.end());
      return t;
    };
    std::vector<std::pair<Triangle, Index>> faces;
    struct EdgeOf {
      std::array<Index, 2> ends;
      bool flat;
      Index triangle;
      bool operator<(const EdgeOf& o) const {
        return std::tie(ends, flat, triangle) < std::tie(o.ends, o.flat, o.triangle);
      }
    };
    std::vector<EdgeOf> edges;
    for (std::size_t t = 0; t < before.size(); ++t) {
      const Triangle f = sorted(before[t]);
      const auto index = static_cast<Index>(t);
      const bool flat =
          mesh::collinear(mesh_.vertices[f[0]], mesh_.vertices[f[1]], mesh_.vertices[f[2]]);
      faces.emplace_back(f, index);
      for (const auto& ends : {std::array{f[0], f[1]}, {f[1], f[2]}, {f[0], f[2]}})
        edges.push_back({ends, flat, index});
    }
    std::sort(faces.begin(), faces.end());
    std::sort(edges.begin(), edges.end());
    const auto source_of = [&](const Triangle& f) {
      const auto face = std::lower_bound(faces.begin(), faces.end(), std::pair(f, Index{0}));
      if (face != faces.end() && face->first == f) return sources[face->second];
      for (const bool flat : {false, true})
        for (const auto& ends : {std::array{f[0], f[1]}, {f[1], f[2]}, {f[0], f[2]}}) {
          const auto edge = std::lower_bound(edges.begin(), edges.end(), EdgeOf{ends, flat, 0});
          if (edge != edges.end() && edge->ends == ends && edge->flat == flat)
            return sources[edge->triangle];
        }
      return sources.front();  // no edge left of what was there: any
    };
    for (const Triangle& t : mesh_.triangles) source_.push_back(source_of(sorted(t)));
  }

  // 1 for every vertex that some triangle names.
  [[nodiscard]] std::vector<char> used_vertices() const {
    std::vector<char> used(mesh_.vertices.size(), 0);
    for (const Triangle& t : mesh_.triangles)
      for (const Index v : t) used[v] = 1;
    return used;
  }

  void report_unused_vertices() {
    const std::vector<char> used = used_vertices();
    const auto first = std::find(used.begin(), used.end(), 0);
    report("unused vertices dropped", static_cast<Index>(std::count(first, used.end(), 0)),
           static_cast<Index>(first - used.begin()));
  }

  void drop_unused_vertices() {
    const std::vector<char> used = used_vertices();
    std::vector<Index> number_of(used.size(), -1);
    Index kept = 0;
    for (Index v = 0; v < vertex_count(); ++v) {
      if (used[v] == 0) continue;
      mesh_.vertices[kept] = mesh_.vertices[v];
      original_[kept] = original_[v];
      number_of[v] = kept++;
    }
    mesh_.vertices.resize(kept);
    original_.resize(kept);
    for (Triangle& t : mesh_.triangles)
      for (Index& v : t) v = number_of[v];
  }

  TriangleMesh mesh_;
  std::vector<Index> source_;    // number in the input of each triangle left
  std::vector<Index> original_;  // number in the input of each vertex
  std::vector<Repair> repairs_;
  std::vector<Repair> kept_;
};

}  // namespace

bool mesh::needs_no_repair(const TriangleMesh& mesh) {
  check_elements(mesh);
  for (const auto& [a, b, c] : mesh.triangles)
    if (a == b || b == c || c == a ||
        collinear(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]))
      return false;
  const auto count = static_cast<Index>(mesh.vertices.size());
  const auto adjacent = triangle_adjacency(mesh.triangles, count);
  for (const auto& [a, b, c] : adjacent) {
    // Two faces on the same three vertices are neighbours across more than one edge.
    if ((a >= 0 && (a == b || a == c)) || (b >= 0 && b == c)) return false;
  }
  // Faces that disagree at an edge, or are more than two there, make several fans.
  return one_fan_each(mesh, adjacent);
}

CleanResult clean(const TriangleMesh& mesh) {
  if (!mesh::needs_no_repair(mesh)) return Cleaner(mesh).run();
  CleanResult result;
  result.mesh = mesh;
  result.source_triangle.resize(mesh.triangles.size());
  result.source_vertex.resize(mesh.vertices.size());
  std::iota(result.source_triangle.begin(), result.source_triangle.end(), Index{0});
  std::iota(result.source_vertex.begin(), result.source_vertex.end(), Index{0});
  return result;
}

}  // namespace nonobtuse
