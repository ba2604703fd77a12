// What a call asks for: options checked, input checked, the number of vertices settled.
#pragma once

#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"
#include "remesh/cvt_optimization.h"
#include "remesh/refinement.h"

namespace nonobtuse::pipeline {

/// Throws InvalidInput, naming the option, for values out of range or options that exclude each
/// other.
void check_options(const RemeshOptions& options);

/// Throws InvalidInput for whatever `clean` would refuse or repair: remeshing never repairs
/// silently. The paper's methods need a manifold.
void check_input(const TriangleMesh& input, Method method);

/// The distance that the result must keep to, input units; 0 for none.
double error_bound(const TriangleMesh& input, const RemeshOptions& options);

/// The number of output vertices: given, or from an edge length h as area / (sqrt(3)/2 h^2), the
/// density of a regular triangulation, or the input's own. At least 4; or 0 where target lengths
/// are given and nothing else, since they say how many.
Index vertex_budget(const TriangleMesh& input, const RemeshOptions& options);

/// Iterations of every stage of the paper's methods: as asked for, or 40 (30 to 50 there).
int paper_iterations(const RemeshOptions& options);

/// The paper's methods start from samples at full size; the default method goes coarse to fine.
CvtOptions cvt_options(const RemeshOptions& options, Index n);

RefinementOptions refinement_options(const RemeshOptions& options);

}  // namespace nonobtuse::pipeline
