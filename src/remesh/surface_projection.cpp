#include "remesh/surface_projection.h"

#include "numeric/vec3.h"

namespace nonobtuse::pipeline {

namespace {
constexpr std::size_t kChunk = 512;
}

SurfaceProjection::SurfaceProjection(const mesh::Surface& surface, const parallel::Workers& workers)
    : surface_(surface), workers_(workers), bvh_(surface.vertices, surface.triangles, workers) {}

PlacedSites SurfaceProjection::place(std::span<const Vec3> points) const {
  PlacedSites out{std::vector<Vec3>(points.size()), std::vector<Vec3>(points.size())};
  workers_.for_each(points.size(), kChunk, [&](std::size_t i) {
    const spatial::TriangleBvh::Hit hit = bvh_.closest(points[i]);
    out.sites[i] = hit.point;
    out.normals[i] = surface_.normals[hit.triangle];
  });
  return out;
}

PlacedSites SurfaceProjection::step(const PlacedSites& from, std::span<const Vec3> direction,
                                    double length) const {
  PlacedSites out = from;
  workers_.for_each(direction.size(), kChunk, [&](std::size_t i) {
    step(out, static_cast<Index>(i), length * direction[i]);
  });
  return out;
}

void SurfaceProjection::step(PlacedSites& placed, Index i, const Vec3& move) const {
  const Vec3 normal = placed.normals[i];
  const double limit = squared_length(move) * (1 + 1e-6);  // the old place is no farther
  const auto same_side = [&](Index t) { return dot(surface_.normals[t], normal) > 0; };
  const auto hit = bvh_.closest_if(placed.sites[i] + move, limit, same_side);
  if (hit.triangle < 0) return;
  placed.sites[i] = hit.point;
  placed.normals[i] = surface_.normals[hit.triangle];
}

}  // namespace nonobtuse::pipeline
