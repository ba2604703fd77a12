// Connected parts of restricted Voronoi cells (Yan, Bao, Zhang, Wonka, Low-resolution remeshing
// using the localized restricted Voronoi diagram, 2014). Where the surface is thin, a Euclidean
// cell reaches through to the other sheet; its localized cell is the part that holds the site.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::rvd {

/// Pieces joined through facet edges.
struct CellComponents {
  std::vector<Index> of_piece;  ///< #P: component, numbered by first piece
  std::vector<Index> site;      ///< #components: whose cell
};
CellComponents cell_components(const mesh::Surface& surface, const RestrictedVoronoi& diagram);

/// For each site the facet nearest to it among those its cell meets; -1 for an empty cell.
std::vector<Index> cell_feet(const mesh::Surface& surface, std::span<const Vec3> sites,
                             const RestrictedVoronoi& diagram);

}  // namespace nonobtuse::rvd
