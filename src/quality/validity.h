// What every measurement needs of a mesh.
#pragma once

#include "nonobtuse/mesh.h"

namespace nonobtuse::quality {

/// Throws InvalidInput, naming the first offending element, unless every coordinate is finite and
/// every index in range.
void require_measurable(const TriangleMesh& mesh);

/// The power of two that brings the largest coordinate to [0.5, 1); 1 if all are 0. Products of
/// a few coordinates so scaled do not overflow.
double unit_scale(const TriangleMesh& mesh);

/// The mesh with all coordinates multiplied by `scale`.
TriangleMesh scaled(const TriangleMesh& mesh, double scale);

}  // namespace nonobtuse::quality
