// Valence optimisation as the paper has it: Yan & Wonka, Non-obtuse Remeshing with Centroidal
// Voronoi Tessellation, TVCG 2016, section 4.2. A site with fewer than 5 or more than 7 neighbours
// is thrown to a random place nearby, and a few Lloyd steps on the sites around, all others fixed,
// mend the gap.
#pragma once

#include <cstdint>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/surface_projection.h"

namespace nonobtuse::pipeline {

/// Rounds over all bad sites that are far enough apart; an attempt is kept only where it lowers the
/// number of bad valences, so that rounds never make things worse (the paper keeps every attempt,
/// and may oscillate). The place is random in the one-ring at first, in wider rings in later
/// rounds. Sites at a boundary are left alone. Returns the number of bad valences left.
Index resample_bad_valences(const mesh::Surface& surface, const SurfaceProjection& projection,
                            PlacedSites& placed, int rounds, std::uint64_t seed,
                            const parallel::Workers& workers, parallel::Monitor& monitor);

}  // namespace nonobtuse::pipeline
