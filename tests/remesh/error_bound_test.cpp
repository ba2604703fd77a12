// Remeshing within a distance: the bound holds when somebody else measures, vertices go where they
// are needed, and what is out of reach is refused in time.
#include "remesh/error_bound.h"

#include <gtest/gtest.h>

#include <vector>

#include "nonobtuse/quality.h"
#include "nonobtuse/remesh.h"
#include "numeric/vec3.h"
#include "rdt/shapes.h"

namespace nonobtuse {
namespace {

TEST(ErrorBound, HoldsWhenMeasuredAnew) {
  const TriangleMesh torus = shapes::torus(80, 40);
  const SurfaceDistance at_first = measure_distance(remesh(torus, {.vertices = 150}).mesh, torus);
  const double bound = at_first.hausdorff / 2;
  const RemeshResult result = remesh(torus, {.vertices = 150, .max_error = bound});
  EXPECT_LE(measure_distance(result.mesh, torus).hausdorff, bound);
  EXPECT_DOUBLE_EQ(result.max_error, measure_distance(result.mesh, torus).hausdorff);
  EXPECT_GT(result.mesh.vertices.size(), 150);
  EXPECT_LT(result.mesh.vertices.size(), 1500);  // about 3 times as many are needed
  EXPECT_EQ(measure_topology(result.mesh).euler_characteristic, 0);
  EXPECT_TRUE(result.certificate.certified);
}

TEST(ErrorBound, MayBeRelative) {
  const TriangleMesh torus = shapes::torus(80, 40);
  const RemeshResult result = remesh(torus, {.vertices = 150, .relative_max_error = 0.01});
  const SurfaceDistance distance = measure_distance(result.mesh, torus);
  EXPECT_LE(distance.hausdorff, 0.01 * distance.diagonal);
}

TEST(ErrorBound, HoldsAtOnceWhereItIsGenerous) {
  const TriangleMesh torus = shapes::torus(80, 40);
  const RemeshResult plain = remesh(torus, {.vertices = 400});
  const RemeshResult bounded = remesh(torus, {.vertices = 400, .max_error = 0.5});
  EXPECT_EQ(plain.mesh.vertices, bounded.mesh.vertices);
  EXPECT_EQ(plain.max_error, 0);
  EXPECT_GT(bounded.max_error, 0);
}

// Two spheres, one a quarter of the other's size: with the same edges its chords are farther away.
TEST(ErrorBound, AddsVerticesWhereTheyAreNeeded) {
  TriangleMesh both = shapes::sphere(4);
  const auto shift = static_cast<Index>(both.vertices.size());
  const TriangleMesh small = shapes::sphere(4);
  for (const Vec3& v : small.vertices) both.vertices.push_back(0.25 * v + Vec3{2, 0, 0});
  for (const Triangle& t : small.triangles)
    both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  const auto share_of_small = [](const TriangleMesh& mesh) {
    std::size_t count = 0;
    for (const Vec3& v : mesh.vertices) count += v.x > 1.5;
    return static_cast<double>(count) / static_cast<double>(mesh.vertices.size());
  };
  const RemeshResult plain = remesh(both, {.vertices = 600});
  const double bound = measure_distance(plain.mesh, both).hausdorff / 2;
  const RemeshResult result = remesh(both, {.vertices = 600, .max_error = bound});
  EXPECT_LE(measure_distance(result.mesh, both).hausdorff, bound);
  EXPECT_GT(share_of_small(result.mesh), 1.5 * share_of_small(plain.mesh));
}

// A remesher that never gets any nearer is not asked for ever.
TEST(ErrorBound, WhatIsOutOfReachIsRefused) {
  const TriangleMesh sphere = shapes::sphere(3);
  RemeshResult rough;
  rough.mesh = shapes::sphere(1);
  int calls = 0;
  const auto remesher = [&](const RemeshOptions& options, const Context&) {
    ++calls;
    EXPECT_EQ(options.max_error, 0);
    return rough;
  };
  try {
    pipeline::remesh_within(sphere, {.vertices = 20, .max_error = 1e-9}, {}, remesher);
    FAIL() << "a sphere is no octahedron";
  } catch (const ErrorBoundNotReached& e) {
    EXPECT_DOUBLE_EQ(e.reached(), measure_distance(rough.mesh, sphere).hausdorff);
  }
  EXPECT_GT(calls, 3);
  EXPECT_LE(calls, 16);
  EXPECT_THROW(remesh(sphere, {.max_error = -1}), InvalidInput);
  EXPECT_THROW(remesh(sphere, {.max_error = 1, .relative_max_error = 1}), InvalidInput);
}

TEST(ErrorBound, CancellationReturnsACompleteMesh) {
  const TriangleMesh torus = shapes::torus(80, 40);
  double last = 0;
  const Context context{.threads = 1, .progress = [&](const Progress& p) {
                          EXPECT_GE(p.fraction, last);
                          last = p.fraction;
                          return p.fraction < 0.6;
                        }};
  const RemeshResult result = remesh(torus, {.vertices = 150, .max_error = 0.01}, context);
  EXPECT_EQ(result.status, Status::Cancelled);
  EXPECT_EQ(result.mesh.vertices.size(), 150);
  EXPECT_EQ(measure_topology(result.mesh).euler_characteristic, 0);
}

}  // namespace
}  // namespace nonobtuse
