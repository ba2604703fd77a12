// The first mesh of a closed surface by few Voronoi diagrams: sites at a quarter of the number, the
// exact dual of their cells, and from there on meshes alone, coarse to fine.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/cvt_optimization.h"
#include "remesh/mesh_tessellation.h"

namespace nonobtuse::pipeline {

struct FirstMesh {
  /// Exactly the vertices asked for, with the topology of the surface: that of the exact dual of
  /// the coarse cells, which are discs, and subdivision and flips preserve it. No vertices where
  /// there is no such mesh, or where it turns against the surface.
  MeshOnSurface tessellation;
  /// In the latter cases the coarse sites, as a start for `optimize_cvt`; may be empty.
  TouchingSites coarse;
};

/// For a closed, connected surface without sizing. Nothing for others and for few vertices; coarse
/// sites alone where the surface is so thin that their cells reach through it. `options` are those
/// of `optimize_cvt` with all sites. Working coordinates. Same bits for any number of threads.
/// After a cancellation: as far as it came.
FirstMesh first_mesh(const mesh::Surface& surface, const CvtOptions& options,
                     const parallel::Workers& workers, parallel::Monitor& monitor);

}  // namespace nonobtuse::pipeline
