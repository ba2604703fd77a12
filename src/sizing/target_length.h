// The field of target edge lengths of a remeshing call, before anything is sampled.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/options.h"
#include "parallel/workers.h"

namespace nonobtuse::sizing {

/// #V: target edge lengths that ask for `vertices` vertices and grow by no more than `gradation`
/// along the surface, in proportion (before that limit) to
/// - lfs^(1/2) for Sizing::LocalFeatureSize: the density 1/lfs^2 of Yan & Wonka 2016, with lfs
///   clamped below at a tenth of the mean edge;
/// - curvature^(-1/2) for Sizing::Curvature: chords at the same distance from the surface, with the
///   radius of curvature clamped alike;
/// - `given` (#V, positive, working lengths) for Sizing::Given; with `vertices` = 0 not scaled.
/// `vertices` > 0 otherwise, and `sizing` not Uniform. Working coordinates.
std::vector<double> target_lengths(const mesh::Surface& surface, Sizing sizing,
                                   std::span<const double> given, Index vertices, double gradation,
                                   const parallel::Workers& workers);

}  // namespace nonobtuse::sizing
