// L-BFGS on all vertices of the mesh at once: shape, angle hinge and two-sided fidelity, with a
// block preconditioner that knows the stiff normal from the soft tangent directions.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"
#include "optimize/lbfgs.h"
#include "parallel/workers.h"
#include "refine/fidelity.h"

namespace nonobtuse::refine {

class GlobalDescent {
 public:
  /// `mesh` (compact) and `fidelity` must outlive this. Boundary vertices stay where they are, but
  /// for those with a knot that slides: all its copies have one unknown, the arc.
  /// With `on_surface` vertices are put back onto the surface in every trial step.
  GlobalDescent(mesh::EditableMesh& mesh, Fidelity& fidelity, bool on_surface,
                const parallel::Workers& workers);

  energy::ShapeWeights shape;

  /// At most `iterations` steps. Call `freeze` before, after every change of connectivity, samples,
  /// planes or weights. `keep_going` is asked once per step.
  void run(int iterations, const std::function<bool()>& keep_going);
  /// Takes over the connectivity and rebuilds the preconditioner.
  void freeze();
  /// Energy at the present positions, and its gradient (#V by 3; zero where vertices are fixed).
  /// The first copy of a knot that slides holds the derivative by its arc in x, the others nothing.
  double evaluate(std::vector<Vec3>& gradient);

 private:
  void precondition(std::span<const Vec3> in, std::span<Vec3> out) const;
  bool search_line(const std::vector<Vec3>& direction, double slope, double first_step);
  void move(const std::vector<Vec3>& direction, double step);
  void put_back();
  // What freeze, evaluate and run do for the knots that slide.
  void freeze_knots();
  void knot_gradient(std::vector<Vec3>& gradient) const;
  void limit_knot_steps(std::vector<Vec3>& direction) const;

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  bool on_surface_;
  const parallel::Workers& workers_;
  optimize::LbfgsHistory history_{7};

  struct Block {
    Vec3 normal;
    double tangential = 1, vertical = 1;  // inverse stiffness
  };
  std::vector<Block> blocks_;
  std::vector<Index> corner_start_, corner_;  // vertex -> 3 t + k
  std::vector<char> fixed_;
  std::vector<char> collapsed_;  // triangles left to local steps: they would hold up all others
  std::vector<Index> sliding_;  // knots
  std::vector<double> arc_origin_;
  std::vector<std::array<Vec3, 3>> corner_gradient_;
  std::vector<Vec3> gradient_, trial_gradient_, origin_;
  double energy_ = 0;
};

}  // namespace nonobtuse::refine
