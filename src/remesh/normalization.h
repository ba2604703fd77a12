// Input coordinates to working coordinates: centred, and scaled to area / #sites = 1.
#pragma once

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::pipeline {

struct NormalizedInput {
  mesh::Surface surface;
  mesh::Normalization map;
};

/// `sites` > 0. Safe for coordinates up to 1e300 and for offsets far from the origin: a first step
/// by powers of two brings the extent to about 1. Throws InvalidInput if the area is zero.
NormalizedInput normalize(const TriangleMesh& input, Index sites);

/// Sum of the triangles' areas in input units, without over- or underflow on the way.
double surface_area(const TriangleMesh& input);

}  // namespace nonobtuse::pipeline
