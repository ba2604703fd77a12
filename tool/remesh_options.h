// The options of `nonobtuse remesh`: how they are asked, and what their words mean.
#pragma once

#include <optional>
#include <string>

#include "command_line.h"

namespace CLI {
class App;
}

namespace nonobtuse::tool {

/// The command as far as its options fill it in, and the words that are still to be read.
struct RemeshDraft {
  RemeshCommand command;
  std::optional<std::string> edge_length;
  std::optional<std::string> max_error;
  std::string method = "default";
  std::string sizing = "uniform";
  std::string features = "auto";
  std::string boundary = "resample";
};

void add_remesh_options(CLI::App& command, RemeshDraft& draft);

/// Throws UsageError for words that mean nothing and options that do not go together.
RemeshCommand checked(const RemeshDraft& draft);

}  // namespace nonobtuse::tool
