// Part of nonobtuse, MIT licence. A surface to try things on.
#pragma once

#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// An implicit surface of genus 3 polygonised by marching cubes on a `resolution`^3 grid: closed,
/// manifold, and full of obtuse and sliver triangles, as such meshes are. Deterministic.
/// Throws InvalidInput unless 16 <= resolution <= 1024.
TriangleMesh sample_surface(Index resolution = 64);

}  // namespace nonobtuse
