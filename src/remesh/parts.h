// A surface taken apart into its connected components (what meets along an edge or in a vertex is
// connected). Each is remeshed on its own: sites of one
// component can then never own a part of another, however close, nested or crossing they are
// (localized cells between components, by construction).
#pragma once

#include <span>
#include <vector>

#include "features/feature_edges.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"

namespace nonobtuse::pipeline {

struct Part {
  TriangleMesh mesh;
  std::vector<Index> facet;  ///< #F of the part: its triangle in the whole mesh
  double area = 0;
  std::vector<double> length;    ///< #V: target edge lengths, input units; empty if uniform
  features::EdgeFlags features;  ///< #F: edges that are features; empty if there are none
  std::vector<Index> points;     ///< vertices in which several fans of triangles touch: kept
  Index least = 4;  ///< vertices to give it at least: first what any surface of its topology needs
                    ///< (Heawood; 3 for a disc), then what was found to do
};

/// By lowest triangle index. The order of vertices and triangles is kept. The mesh must be clean.
/// With target edge lengths (#V, else empty) `area` is the number of vertices they ask for.
std::vector<Part> connected_parts(const TriangleMesh& mesh, std::span<const double> length = {});

/// Sets the features of every part as the options say, boundaries among them. Throws InvalidInput
/// for feature edges that are none.
void find_features(const TriangleMesh& mesh, const RemeshOptions& options,
                   std::vector<Part>& parts);

/// Sum of `least` over the parts.
Index least_vertices(const std::vector<Part>& parts);

/// n vertices shared out in proportion to area (with sizing to the vertices asked for), at least
/// `least` for each part; n must not be smaller than their sum.
std::vector<Index> share_vertices(const std::vector<Part>& parts, Index n);

}  // namespace nonobtuse::pipeline
