// Knots on feature curves, made vertices of the surface, and the surface cut open along its
// features: patches that meet in copies of the same knots.
#pragma once

#include <vector>

#include "features/feature_edges.h"
#include "features/feature_graph.h"
#include "mesh/curve_network.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// A surface whose knots are vertices, not cut yet.
struct KnottedSurface {
  std::vector<Vec3> vertices;  ///< the surface's own first
  std::vector<double> size;    ///< #V; empty if uniform
  std::vector<Triangle> triangles;
  EdgeFlags flags;           ///< #F
  std::vector<Index> facet;  ///< #F: the facet of the surface it is a part of
  std::vector<Index> knot;   ///< #V: -1 where there is none
  mesh::CurveNetwork network;
  std::vector<Index> source;  ///< #knots: the vertex of the surface a knot is at; -1 elsewhere
};

/// Knots: every corner (fixed), and on every curve as many as make segments[c] segments of equal
/// length in the sizing metric; those nearer to a vertex of the curve than `snap` (working units,
/// times the local size) go there. Where `frozen` says so (#curves, or empty) the knots are the
/// curve's vertices instead, fixed. Of the surface's vertices the first `originals` are the
/// input's; others are on edges of it and neither frozen nor a source.
KnottedSurface insert_knots(const mesh::Surface& surface, const EdgeFlags& flags,
                            const FeatureGraph& graph, const std::vector<Index>& segments,
                            const std::vector<char>& frozen, double snap, Index originals);

/// The surface cut open: a vertex on features once per sector between them.
struct CutSurface {
  mesh::Surface surface;
  std::vector<Index> facet;  ///< #F, as in KnottedSurface
  std::vector<Index> knot;   ///< #V
};
CutSurface cut_open(const KnottedSurface& knotted);

}  // namespace nonobtuse::features
