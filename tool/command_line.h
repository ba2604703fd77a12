// What can be asked of the tool, and how it is asked.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "nonobtuse/certificate.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"

namespace nonobtuse::tool {

struct OutputOptions {
  std::string path;
  bool ascii = false;  ///< PLY and STL as text instead of binary
};

struct RemeshCommand {
  std::string input;
  OutputOptions output;
  RemeshOptions options;
  std::string report;         ///< .html or .json; empty: none
  std::string command_line;   ///< as given, to do it again
  std::string sizes;          ///< file of target edge lengths, with Sizing::Given
  bool keep_seams = false;    ///< borders of labels and seams of textures are features
  std::string feature_edges;  ///< file of pairs of vertices, with Features::Given
  int threads = 0;
  bool quiet = false;        ///< print nothing but errors
  bool progress = false;     ///< report progress even if stderr is no terminal
  bool json = false;         ///< print JSON instead of the table
  bool no_distance = false;  ///< do not measure the distance to the input
};

struct MeasureCommand {
  std::string input;
  std::string reference;  ///< empty: no distances
  int threads = 0;
  bool json = false;
};

struct CertifyCommand {
  std::string input;
  CertificateBounds bounds;
  Index worst = 5;  ///< triangles to name
  bool json = false;
};

struct ConvertCommand {
  std::string input;
  OutputOptions output;
};

struct SampleCommand {
  OutputOptions output;
  Index resolution = 64;
};

/// Exactly one command is set, or none if there is only `message` to print.
struct CommandLine {
  std::optional<RemeshCommand> remesh;
  std::optional<MeasureCommand> measure;
  std::optional<CertifyCommand> certify;
  std::optional<ConvertCommand> convert;
  std::optional<SampleCommand> sample;
  std::string message;  ///< the text of --help or --version
};

/// The command line is wrong; what() is one sentence.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws UsageError. Checks everything that can be checked without opening a file.
CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace nonobtuse::tool
