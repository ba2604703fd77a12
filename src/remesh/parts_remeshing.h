// All connected parts of a surface, each with its share of the vertices; parts that turn out to
// need more take them from the others.
#pragma once

#include <optional>
#include <vector>

#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/feature_plan.h"
#include "remesh/parts.h"
#include "remesh/stage_clock.h"

namespace nonobtuse::pipeline {

/// Remeshes all parts with the vertices they are given. Small parts come first: one that needs more
/// says so in its `least`, and those that give them, the large parts, wait until all others have
/// enough. What was done is kept while a part's number of vertices stays.
class PartsRemesher {
 public:
  /// All must outlive this.
  PartsRemesher(std::vector<Part>& parts, const RemeshOptions& options,
                const parallel::Workers& workers, StageClock& clock);

  /// With this many vertices (#parts). False if a part needs more.
  bool run(const std::vector<Index>& vertices);

  /// The result of all parts, in their order: meshes, sources, features and what became of them.
  RemeshResult take();

 private:
  // What a part became with the vertices it was given.
  struct PartResult {
    Index planned = -1;  // for this many vertices
    std::optional<FeaturePlan> plan;
    Index meshed = -1;  // with this many vertices
    RemeshResult result;
  };

  bool run(const std::vector<std::size_t>& some, const std::vector<Index>& vertices);
  void begin(double share);
  void plan(std::size_t c, Index n);
  void mesh(std::size_t c, Index n);

  std::vector<Part>& parts_;
  const RemeshOptions& options_;
  const parallel::Workers& workers_;
  StageClock& clock_;
  std::vector<PartResult> results_;
  Index whole_ = 0;  // vertices
  double done_ = 0;
};

/// Sets `least` of every part to a number of vertices that was tried and does.
void find_least_vertices(std::vector<Part>& parts, const RemeshOptions& options,
                         const parallel::Workers& workers, StageClock& clock);

}  // namespace nonobtuse::pipeline
