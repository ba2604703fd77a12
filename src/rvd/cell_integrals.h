// Energy, area and centroid of every restricted Voronoi cell: one evaluation of the CVT energy and
// of all that its gradient needs (Yan, Levy, Liu, Sun, Wang, Isotropic remeshing with fast and
// exact computation of restricted Voronoi diagram, 2009). Unlike there, each facet keeps the list
// of the sites that can own a part of it over many evaluations: see candidate_lists.h.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mesh/surface.h"
#include "parallel/pool.h"
#include "parallel/workers.h"
#include "rvd/candidate_lists.h"
#include "rvd/facet_pieces.h"
#include "rvd/site_grid.h"

namespace nonobtuse::rvd {

/// Integrals over the restricted Voronoi cells, with the density of the surface (size^-4; 1 if
/// uniform).
struct CellIntegrals {
  double energy = 0;           ///< Eq. 1: sum over cells of the integral of |x - x_i|^2
  std::vector<double> mass;    ///< #X: of each cell; its area if the density is uniform
  std::vector<Vec3> centroid;  ///< #X by 3; the site itself where the cell is empty
  /// #X: the mass that a cell of the right size has there, for judging its own; empty if uniform.
  std::vector<double> expected_mass;
};

/// What a cell has of one piece of a facet.
struct CellPart {
  Index site;
  double mass;
  Vec3 centroid;
};

/// Evaluates the cells of moving sites on one surface. A part of the surface at equal distance from
/// several sites belongs to the lowest index; what is cheap when sites move little (lists are
/// reused) is exact always. Same bits for any number of threads. Not thread-safe; parallel inside.
/// Memory: about 150 bytes per facet and 900 per site.
class CellEvaluator {
 public:
  /// The surface is not kept. `site_count` >= 1 is the number of sites of every evaluation.
  CellEvaluator(const mesh::Surface& surface, Index site_count, const parallel::Workers& workers);
  ~CellEvaluator();

  /// `sites` (#X by 3, finite; coincident ones allowed) in any order, but fastest in one that
  /// keeps neighbours together, and the same in every call.
  void evaluate(std::span<const Vec3> sites, CellIntegrals& out);

  /// Pairs i < j of sites whose cells met along a curve in the last evaluation: the edges of the
  /// restricted Delaunay triangulation, without the care for ties of the exact engine. Sorted.
  [[nodiscard]] std::vector<std::array<Index, 2>> adjacent_cells() const;

  /// The parts of the pieces of facets that belong to the sites marked in `wanted` (#X) after the
  /// last evaluation, piece by piece. For uniform density.
  [[nodiscard]] std::vector<CellPart> parts_of(std::span<const char> wanted) const;

  /// Forgets all lists: the next evaluation starts from scratch.
  void reset();

  /// How much work the evaluations so far took.
  struct Statistics {
    long long evaluations = 0;
    long long pieces = 0;    ///< pieces of facets, over all evaluations
    long long relisted = 0;  ///< of these, with a new candidate list
  };
  [[nodiscard]] Statistics statistics() const;

 private:
  struct Chunk;
  struct Scratch;

  void refresh(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const;
  bool spend_budgets(Chunk& chunk, Scratch& scratch) const;
  void find_bases(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const;
  void relist(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const;
  void integrate(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const;
  void integrate_weighted(Chunk& chunk, std::span<const Vec3> sites, Scratch& scratch) const;
  void sum_chunks(std::span<const Vec3> sites, CellIntegrals& out) const;
  [[nodiscard]] std::vector<std::array<Index, 2>> adjacent_cells(const Chunk& chunk) const;

  const parallel::Workers& workers_;
  Index site_count_;
  FacetPieces pieces_;
  double flat_energy_ = 0;  // see flat_energy
  SiteGrid grid_;
  std::vector<Vec3> previous_;  // sites of the last evaluation
  std::vector<double> step_;    // #X: distance moved since
  std::vector<std::unique_ptr<Chunk>> chunks_;
  mutable parallel::Pool<Scratch> pool_;
  long long evaluations_ = 0;
};

}  // namespace nonobtuse::rvd
