// Runs the built tool as a shell would and looks at what comes back.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cli {

struct Outcome {
  int exit_code = -1;  ///< -1 if it did not exit by itself
  int signal = 0;      ///< that ended it, 0 if none
  bool timed_out = false;
  std::string out;
  std::string err;
};

/// Called about every 5 ms with the process and what it has written to stderr so far.
using Watcher = std::function<void(int pid, const std::string& err)>;

Outcome run_tool(const std::vector<std::string>& arguments, double seconds = 60,
                 const Watcher& watch = {});

/// A fresh folder per test, removed afterwards.
class ToolTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  /// Writes the sample surface and returns its path.
  [[nodiscard]] std::string sample(int resolution = 16);

  std::filesystem::path folder_;
};

std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);
bool exists(const std::string& path);

/// One line on stderr, "nonobtuse: ...", and nothing on stdout.
testing::AssertionResult is_one_sentence(const Outcome& outcome);

/// Runs `measure --json` on a file.
nlohmann::json measured(const std::string& path);

}  // namespace cli
