// What each command does; each returns an exit code and throws what the library throws.
#pragma once

#include "command_line.h"
#include "nonobtuse/attributes.h"

namespace nonobtuse::tool {

int run(const RemeshCommand& command);
int run(const MeasureCommand& command);
int run(const CertifyCommand& command);
int run(const ConvertCommand& command);
int run(const SampleCommand& command);

/// The output cannot be written, as opposed to the input not being readable.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// write_mesh whose IoError becomes an OutputError.
void write_output(const OutputOptions& output, const TriangleMesh& mesh,
                  const MeshAttributes& attributes = {});

}  // namespace nonobtuse::tool
