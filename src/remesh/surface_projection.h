// Sites held on the surface while an optimiser moves them.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

/// Sites on the surface (#X by 3) and the unit normals of the facets under them.
struct PlacedSites {
  std::vector<Vec3> sites;
  std::vector<Vec3> normals;
};

/// Finds the surface point nearest to a site. Keeps references to the surface and the workers.
class SurfaceProjection {
 public:
  SurfaceProjection(const mesh::Surface& surface, const parallel::Workers& workers);

  /// Nearest points, wherever they lie.
  [[nodiscard]] PlacedSites place(std::span<const Vec3> points) const;

  /// Nearest points after the steps `length * direction[i]`. Behind a thin part of the surface the
  /// far side may be nearer: facets that face away from the site's own normal do not count, and a
  /// site that finds no other within its step stays where it is.
  [[nodiscard]] PlacedSites step(const PlacedSites& from, std::span<const Vec3> direction,
                                 double length) const;

  /// The same for the one site i, moved by `move`, in place.
  void step(PlacedSites& placed, Index i, const Vec3& move) const;

 private:
  const mesh::Surface& surface_;
  const parallel::Workers& workers_;
  spatial::TriangleBvh bvh_;
};

}  // namespace nonobtuse::pipeline
