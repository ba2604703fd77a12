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

/// Connected sets of pieces of one owner, joined through facet edges and, where two pieces of one
/// facet have the same owner, through their bisector.
struct CellComponents {
  std::vector<Index> of_piece;  ///< #P: component, numbered by first piece
  std::vector<Index> owner;     ///< #components: whose cell
};
/// `owner` (#P): diagram.site for the plain cells.
CellComponents cell_components(const mesh::Surface& surface, const RestrictedVoronoi& diagram,
                               std::span<const Index> owner);

/// For each site the facet nearest to it among those its cell meets; -1 for an empty cell.
std::vector<Index> cell_feet(const mesh::Surface& surface, std::span<const Vec3> sites,
                             const RestrictedVoronoi& diagram);

/// Every piece given to a cell so that all cells are connected.
struct LocalizedCells {
  std::vector<Index> owner;  ///< #P: site
  Index orphans = 0;         ///< components that went to another site than their own
};

/// A site keeps the component of its piece in its foot facet (the largest one, if it has no piece
/// there); every other component, an orphan, goes whole to the neighbour with the longest common
/// boundary, longest first. `feet` as cell_feet gives them.
LocalizedCells localized_cells(const mesh::Surface& surface, std::span<const Vec3> sites,
                               const RestrictedVoronoi& diagram, std::span<const Index> feet);

}  // namespace nonobtuse::rvd
