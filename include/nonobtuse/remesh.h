// Part of nonobtuse, MIT licence. The one call.
#pragma once

#include "nonobtuse/context.h"
#include "nonobtuse/error.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"

namespace nonobtuse {

/// Remeshes a manifold triangle surface so that every angle lies inside the bounds.
///
/// `input` must be manifold and consistently oriented (see `clean` in io.h for files); it may have
/// several components. The result has exactly the vertices asked for, and the components, Euler
/// characteristic and boundary loops of the input. Angles that could not be brought inside the
/// bounds are listed in `result.goal` and `result.certificate`; they are never hidden.
///
/// With a max_error the call is repeated with more vertices where the distance is too large.
///
/// Throws InvalidInput if the input or an option is unusable, and its subclass TooFewVertices if
/// the topology needs more vertices, or ErrorBoundNotReached if the distance asked for is out of
/// reach. Thread-safe. Deterministic: same input, options and seed give
/// the same result for any number of threads.
///
/// Reference: Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG 2016.
RemeshResult remesh(const TriangleMesh& input, const RemeshOptions& options = {},
                    const Context& context = {});

}  // namespace nonobtuse
