// What the tool's exit codes mean; the same list is in --help and README.md.
#pragma once

namespace nonobtuse::tool {

enum ExitCode : int {
  kDone = 0,          ///< done and, where there is something to certify, certified
  kAnglesRemain = 1,  ///< done, but some angle is outside the bounds asked for
  kBadUsage = 2,      ///< command line wrong, or the output cannot be written where it says
  kBadInput = 3,      ///< the input cannot be read or used
  kCancelled = 4,     ///< interrupted; the best valid mesh so far was written
  kInternal = 5,      ///< a bug
};

}  // namespace nonobtuse::tool
