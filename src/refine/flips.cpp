#include "refine/flips.h"

#include <algorithm>

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 4;
// In a good mesh the other diagonal is 1.7 times as long; one more than 1.5 times as long as the
// edge makes obtuse triangles.
constexpr double kLongestDiagonal = 2.25;  // squared

using Corners = std::array<Vec3, 3>;

// Energy of the samples of two triangles against the nearer of another two (or the same).
double samples_against(const Fidelity& fidelity, Index t, const TriangleFrame& a,
                       const TriangleFrame& b) {
  double sum = 0;
  for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next) {
    const Sample& sample = fidelity.samples[s];
    sum += sample.weight * std::min(a.closest(sample.point).squared_distance,
                                    b.closest(sample.point).squared_distance);
  }
  return fidelity.weights.to_mesh * sum;
}

// Energy lost by flipping e: positive if the flip pays.
double flip_gain(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                 const energy::ShapeWeights& shape, mesh::Edge e) {
  const mesh::Edge o = mesh.twin(e);
  const Index vp = mesh.opposite_vertex(e), vq = mesh.opposite_vertex(o);
  const Index va = mesh.tail(e), vb = mesh.head(e);
  const Vec3 p = mesh.positions[vp], q = mesh.positions[vq];
  const Vec3 a = mesh.positions[va], b = mesh.positions[vb];
  const Corners old1{p, a, b}, old2{q, b, a}, new1{p, a, q}, new2{q, b, p};
  const TargetSize& size = fidelity.size;
  const double gain = size.shape({vp, va, vb}, old1, shape) +
                      size.shape({vq, vb, va}, old2, shape) -
                      size.shape({vp, va, vq}, new1, shape) - size.shape({vq, vb, vp}, new2, shape);
  // Fidelity alone may pay for a flip, but not for a much worse shape.
  if (!(gain > -1)) return gain;
  const TriangleFrame f1(p, a, b), f2(q, b, a), g1(p, a, q), g2(q, b, p);
  double fidelity_gain = 0;
  for (Index t : {e.triangle, o.triangle})
    fidelity_gain += samples_against(fidelity, t, f1, f2) - samples_against(fidelity, t, g1, g2);
  return gain + fidelity_gain;
}

bool worth_trying(const mesh::EditableMesh& mesh, mesh::Edge e) {
  const mesh::Edge o = mesh.twin(e);
  if (!o.valid()) return false;
  const double diagonal = squared_distance(mesh.positions[mesh.opposite_vertex(e)],
                                           mesh.positions[mesh.opposite_vertex(o)]);
  return diagonal < kLongestDiagonal * squared_distance(mesh.positions[mesh.tail(e)],
                                                        mesh.positions[mesh.head(e)]);
}

bool try_flip(mesh::EditableMesh& mesh, Fidelity& fidelity, const energy::ShapeWeights& shape,
              mesh::Edge e) {
  if (!worth_trying(mesh, e) || !flip_allowed(mesh, fidelity, e)) return false;
  if (!(flip_gain(mesh, fidelity, shape, e) > 1e-9)) return false;
  const Index other = mesh.twin(e).triangle;
  mesh.flip(e);
  const std::array<Index, 2> pair{e.triangle, other};
  fidelity.redistribute(mesh, pair);
  for (Index t : pair) fidelity.update_triangle(mesh, t);
  return true;
}

}  // namespace

bool flip_allowed(const mesh::EditableMesh& mesh, const Fidelity& fidelity, mesh::Edge e) {
  if (!mesh.can_flip(e)) return false;
  const mesh::Edge o = mesh.twin(e);
  const Index a = mesh.tail(e), b = mesh.head(e);
  const Index p = mesh.opposite_vertex(e), q = mesh.opposite_vertex(o);
  const auto allowed = [&](Index v, int change) {
    return fidelity.valences.change_allowed(v, mesh.valence(v), mesh.valence(v) + change);
  };
  if (!allowed(a, -1) || !allowed(b, -1) || !allowed(p, 1) || !allowed(q, 1)) return false;
  if (!fidelity.knots.edge_allowed(mesh, p, q)) return false;
  const std::vector<Vec3>& x = mesh.positions;
  const Vec3 old1 = area_vector(x[p], x[a], x[b]), old2 = area_vector(x[q], x[b], x[a]);
  const Vec3 new1 = normalized(area_vector(x[p], x[a], x[q]));
  const Vec3 new2 = normalized(area_vector(x[q], x[b], x[p]));
  const Vec3 mean = normalized(old1 + old2);
  if (dot(new1, mean) < 0.3 || dot(new2, mean) < 0.3) return false;
  const double turn = dot(new1, new2);
  return turn > 0.5 || turn > dot(normalized(old1), normalized(old2));
}

Index flip_edges(mesh::EditableMesh& mesh, Fidelity& fidelity, const energy::ShapeWeights& shape,
                 const std::vector<Index>* triangles) {
  Index flips = 0;
  std::vector<Index> work, changed;
  if (triangles) {
    work = *triangles;
  } else {
    for (Index t = 0; t < mesh.triangle_capacity(); ++t) work.push_back(t);
  }
  for (int round = 0; round < kRounds && !work.empty(); ++round) {
    changed.clear();
    for (Index t : work) {
      if (!mesh.alive_triangle(t)) continue;
      for (int k = 0; k < 3; ++k) {
        const mesh::Edge e{t, k};
        const Index across = mesh.adjacent(t, k);
        if (across < 0 || (!triangles && round == 0 && across < t)) continue;
        if (!try_flip(mesh, fidelity, shape, e)) continue;
        ++flips;
        for (Index side : {t, across}) {
          changed.push_back(side);
          for (int j = 0; j < 3; ++j)
            if (mesh.adjacent(side, j) >= 0) changed.push_back(mesh.adjacent(side, j));
        }
        break;
      }
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    work.swap(changed);
  }
  return flips;
}

}  // namespace nonobtuse::refine
