// Creases of a surface by dihedral angle, with hysteresis (Hubeli, Gross, Multiresolution feature
// extraction for unstructured meshes, 2001): sharp edges, continued along blunter ones that stand
// out against their neighbourhood.
#pragma once

#include "features/feature_edges.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// Flags the creases of a connected surface. None on a smooth one, however coarse or noisy: there
/// the number of edges falls off gradually with the dihedral angle, where a part with sharp edges
/// has a gap between what bends smoothly and what is sharp. O(#F), deterministic.
void detect_creases(const mesh::Surface& surface, EdgeFlags& flags);

/// Of a surface with creases (does nothing without): flags edges at which the normal turns by 20
/// degrees or more between two flat places, both wider than `width` (working units). A coarse
/// prism is kept as it is by meshes finer than its sides.
void flag_coarse_creases(const mesh::Surface& surface, double width, EdgeFlags& flags);

/// Flags all edges at which the normal turns by `degrees` or more; nothing else is considered.
void flag_dihedral_angles(const mesh::Surface& surface, double degrees, EdgeFlags& flags);

}  // namespace nonobtuse::features
