// The sizing of a call: target edge lengths at the input's vertices, in its own units, how many
// vertices they ask for, and how well a result realises them.
#pragma once

#include <vector>

#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/normalization.h"

namespace nonobtuse::pipeline {

struct SizeField {
  std::vector<double> length;  ///< #V: target edge lengths, input units; empty if uniform
  Index vertices = 0;          ///< of the result
};

/// `vertices` is the number asked for, or 0 where Sizing::Given is to say it. Throws InvalidInput
/// if the target lengths given are unusable.
SizeField size_field(const TriangleMesh& input, const RemeshOptions& options, Index vertices,
                     const parallel::Workers& workers);

/// Hands target lengths (input units, #V; may be empty) to a normalised surface, as sizes relative
/// to a uniform mesh.
void set_sizes(const std::vector<double>& length, NormalizedInput& input);

/// Of a finished result, by source_triangle and barycentric.
SizeRatio size_ratio(const TriangleMesh& input, const SizeField& field, const RemeshResult& result);

}  // namespace nonobtuse::pipeline
