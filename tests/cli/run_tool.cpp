#include "cli/run_tool.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

namespace cli {
namespace {

using Clock = std::chrono::steady_clock;

// The tool is several times slower under the sanitizers.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kPatience = 5;
#else
constexpr double kPatience = 1;
#endif

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("nonobtuse-" + std::to_string(getpid()) + "-" + name);
}

int start(const std::vector<std::string>& arguments, const std::string& out,
          const std::string& err) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), flags, 0600), STDERR_FILENO);
  std::vector<char*> argv{const_cast<char*>(NONOBTUSE_TOOL_PATH)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

}  // namespace

Outcome run_tool(const std::vector<std::string>& arguments, double seconds, const Watcher& watch) {
  const std::string out = scratch("out").string();
  const std::string err = scratch("err").string();
  Outcome outcome;
  const pid_t pid = start(arguments, out, err);
  const auto deadline = Clock::now() + std::chrono::duration<double>(kPatience * seconds);
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (watch) watch(pid, read_file(err));
    if (!outcome.timed_out && Clock::now() > deadline) {
      outcome.timed_out = true;
      kill(pid, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  outcome.out = read_file(out);
  outcome.err = read_file(err);
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

void ToolTest::SetUp() {
  folder_ = scratch("folder");
  std::filesystem::create_directories(folder_);
}

void ToolTest::TearDown() { std::filesystem::remove_all(folder_); }

std::string ToolTest::sample(int resolution) {
  const std::string file = path("sample.obj");
  const Outcome outcome =
      run_tool({"sample", "-o", file, "--resolution", std::to_string(resolution)});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return file;
}

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

testing::AssertionResult is_one_sentence(const Outcome& outcome) {
  if (!outcome.out.empty())
    return testing::AssertionFailure() << "stdout is not empty: " << outcome.out;
  if (outcome.err.rfind("nonobtuse: ", 0) != 0 || outcome.err.size() < 20 ||
      std::count(outcome.err.begin(), outcome.err.end(), '\n') != 1 || outcome.err.back() != '\n')
    return testing::AssertionFailure() << "stderr is not one sentence: '" << outcome.err << "'";
  return testing::AssertionSuccess();
}

nlohmann::json measured(const std::string& path) {
  const Outcome outcome = run_tool({"measure", path, "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

}  // namespace cli
