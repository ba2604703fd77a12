// What every benchmark works on: a surface in working coordinates and CVT sites on it, made once.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::bench {

struct BenchInput {
  TriangleMesh mesh;      ///< cleaned input
  mesh::Surface surface;  ///< working coordinates
  spatial::TriangleBvh bvh;
  std::vector<Vec3> sites;
};

/// The model named by the environment variable NONOBTUSE_BENCH_MODEL with
/// NONOBTUSE_BENCH_VERTICES sites (default: `sample_surface(64)` with 8000).
const BenchInput& bench_input();

}  // namespace nonobtuse::bench
