// A result within a given distance of the input: where the measured two-sided distance is too large
// the target edge length shrinks, and the whole surface is remeshed with that field, until the
// bound holds. On a smooth surface the distance of a triangle grows with the square of its edges,
// which says how far to shrink; at creases and in valleys it grows with the edges themselves, so
// that a few more rounds are needed there.
#pragma once

#include <functional>

#include "nonobtuse/context.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"

namespace nonobtuse::pipeline {

/// A remeshing call without a bound.
using Remesh = std::function<RemeshResult(const RemeshOptions&, const Context&)>;

/// `remesh` with more and more vertices, from those of the options on, until the distance measured
/// (that of `measure_distance`) is at most the options' max_error; its result, with the distance in
/// `max_error`. Throws ErrorBoundNotReached after 16 rounds, beyond 100 times the vertices at the
/// start (at least 100 000), or when four rounds with half as many vertices again have brought the
/// distance down by less than 5 %.
/// A cancellation returns the last complete result, if there is one.
RemeshResult remesh_within(const TriangleMesh& input, const RemeshOptions& options,
                           const Context& context, const Remesh& remesh);

}  // namespace nonobtuse::pipeline
