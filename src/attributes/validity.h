// Whether attributes belong to a mesh, and what its seams are.
#pragma once

#include <array>
#include <vector>

#include "nonobtuse/attributes.h"

namespace nonobtuse::attributes {

/// Throws InvalidInput, naming the array and the element, unless every array is empty or complete
/// and every index in range.
void require_valid(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// Whether two faces have the same texture coordinate at a vertex that both have; by value, since
/// many files repeat equal coordinates. True without a texture.
bool texture_agrees(const TriangleMesh& mesh, const MeshAttributes& attributes, Index t,
                    Index other, Index vertex);

/// Whether edge k of face t, with face `other` across it, is a seam.
bool is_seam(const TriangleMesh& mesh, const MeshAttributes& attributes, Index t, int k,
             Index other);

}  // namespace nonobtuse::attributes
