// Centroidal tessellation by localized cells (Yan, Bao, Zhang, Wonka 2014), run where the plain
// cells are not discs: thin parts, where a Euclidean cell reaches through to the other sheet.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "rdt/closed_ball.h"
#include "rvd/localized_cells.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::pipeline {

/// The diagram of some sites, localized, with its dual and what is wrong with it.
struct SiteCells {
  rvd::RestrictedVoronoi diagram;
  rvd::LocalizedCells localized;
  std::vector<Index> feet;  ///< #X: facet under each site, in its own cell; -1 for an empty cell
  std::vector<Triangle> triangles;          ///< the dual of the localized cells
  std::vector<rdt::DefectiveCell> defects;  ///< empty: the dual is a mesh of the surface
};

SiteCells site_cells(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                     const parallel::Workers& workers);

/// Over-relaxed Lloyd steps with localized cells; sites slide on the facets of their own cell and
/// so never jump to another sheet. Every few steps the sites that matter least move to where cells
/// are not discs (closed-ball repair at a constant number of sites). Stops as soon as the dual is
/// valid and no cell reaches through any more, or when repairs bring nothing more, or cancelled;
/// with `fixed` also as soon as a repair brings nothing on a large patch that is crumpled
/// everywhere. `cells` must be those of `sites`, and is so afterwards. Sites marked in `fixed` (#X,
/// or empty) stay where they are.
void localize_sites(const mesh::Surface& surface, std::vector<Vec3>& sites, SiteCells& cells,
                    const parallel::Workers& workers, parallel::Monitor& monitor,
                    std::span<const char> fixed = {});

}  // namespace nonobtuse::pipeline
