// The functions that the paper's own stages minimise: Yan & Wonka, Non-obtuse Remeshing with
// Centroidal Voronoi Tessellation, TVCG 2016, Eq. 1 or 2 plus lambda times Eq. 4 (Eq. 3).
#pragma once

#include <tuple>
#include <vector>

#include "mesh/surface.h"
#include "numeric/symmetric_matrix.h"
#include "parallel/workers.h"
#include "remesh/restricted_diagram.h"
#include "remesh/surface_projection.h"

namespace nonobtuse::pipeline {

/// Terms of the energy, each scaled so that its weight means the same for any model and number of
/// sites. All may be combined.
struct PenaltyWeights {
  /// s of Eq. 2; 1 for the plain CVT energy of Eq. 1.
  double normal_weight = 1;
  /// lambda of Eq. 3, times area / #X. Useful from .003 to .03; at .1 and above the penalty is far
  /// stiffer than the CVT (126 times at 1): it over-smooths and stalls.
  double short_dual = 0;
  /// epsilon of Eq. 4, relative to the edge's length.
  double relative_epsilon = 0.1;
  /// Drop the normal part of the penalty's vectors r_i. Without (as in the paper) sites that are
  /// held on the surface come out closer to it, with it the angles are a little better.
  bool tangential = false;
  /// Weight of the circumcentre term (Sieger et al. 2010), times area / #X; not in the paper.
  double circumcentre = 0;
  /// Weight of the angle hinge, times 6.23 F_cvt / #X; not in the paper.
  double hinge = 0;
  double hinge_small = 35;  ///< degrees: smaller angles are penalised by the hinge
  double hinge_large = 86;  ///< degrees: larger ones too
};

/// What is best: fewest cells that are no discs (there the triangles are no manifold), then fewest
/// obtuse triangles, then fewest small angles, then least energy.
struct Score {
  std::size_t defects = 0;
  Index obtuse = 0;
  Index small = 0;
  double energy = 0;

  friend bool operator<(const Score& a, const Score& b) {
    return std::tie(a.defects, a.obtuse, a.small, a.energy) <
           std::tie(b.defects, b.obtuse, b.small, b.energy);
  }
};

struct Evaluation {
  Score score;
  std::vector<Vec3> gradient;                     ///< #X by 3, tangential
  std::vector<numeric::SymmetricMatrix> hessian;  ///< #X: its blocks on the diagonal, about
  std::vector<double> cell_area;                  ///< #X
  std::vector<Index> blocked;                     ///< sites of defective cells, their neighbours
};

/// Keeps references to its arguments. Not thread-safe; parallel inside.
class PenalizedEnergy {
 public:
  PenalizedEnergy(const mesh::Surface& surface, const PenaltyWeights& weights,
                  const parallel::Workers& workers)
      : surface_(surface), weights_(weights), workers_(workers) {}

  [[nodiscard]] Evaluation evaluate(const PlacedSites& x);

 private:
  void add_cells(const PlacedSites& x, const RestrictedDiagram& diagram, Evaluation& result) const;
  void add_penalties(const PlacedSites& x, const RestrictedDiagram& diagram,
                     Evaluation& result) const;

  const mesh::Surface& surface_;
  const PenaltyWeights& weights_;
  const parallel::Workers& workers_;
  double hinge_scale_ = -1;  // from the first CVT energy: the same function at every evaluation
};

}  // namespace nonobtuse::pipeline
