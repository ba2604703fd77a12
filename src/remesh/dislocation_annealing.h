// Fewer irregular vertices where cells are coarse against the surface: pairs of valence 5 and 7,
// the dislocations of a triangulation, glide by flips until they meet and annihilate.
#pragma once

#include <cstdint>
#include <functional>

#include "mesh/surface.h"
#include "remesh/mesh_tessellation.h"

namespace nonobtuse::pipeline {

/// Whether annealing is worth its time: a closed mesh without sizing, of few vertices, whose
/// triangles are worse than those of cells that are small against the surface's curvature.
bool is_coarse(const mesh::Surface& surface, const MeshOnSurface& tessellation);

/// Simulated annealing over flips that keep or lower the sum of (valence - 6)^2. After every flip
/// the vertices around slide on the surface to where triangles are nearest to equilateral and edges
/// near the surface; it stays if that costs no more than a random part of the temperature, which
/// falls to zero. Keeps the number of vertices and the topology. Deterministic; one thread. Asks
/// `keep_going(fraction)` between sweeps.
void anneal_dislocations(const mesh::Surface& surface, MeshOnSurface& tessellation,
                         std::uint64_t seed, const std::function<bool(double)>& keep_going);

}  // namespace nonobtuse::pipeline
