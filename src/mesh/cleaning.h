// The quick answer of `clean` for the many meshes that need nothing.
#pragma once

#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// Whether `clean` would leave the mesh as it is: every triangle with area, a manifold that is
/// consistently oriented, no vertex unused. Linear. Throws InvalidInput as `clean` does for
/// coordinates that are not finite and indices out of range.
bool needs_no_repair(const TriangleMesh& mesh);

}  // namespace nonobtuse::mesh
