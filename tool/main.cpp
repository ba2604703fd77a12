// nonobtuse, the command-line tool: parse, run one command, turn exceptions into exit codes.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "command_line.h"
#include "commands.h"
#include "exit_code.h"
#include "nonobtuse/error.h"

namespace {

using namespace nonobtuse;
using namespace nonobtuse::tool;

int run_command(int argc, const char* const* argv) {
  const CommandLine line = parse_command_line(argc, argv);
  if (line.remesh) return run(*line.remesh);
  if (line.measure) return run(*line.measure);
  if (line.certify) return run(*line.certify);
  if (line.convert) return run(*line.convert);
  if (line.sample) return run(*line.sample);
  fmt::print("{}", line.message);
  return kDone;
}

// One sentence on one line, whatever the text says: it may quote what was given.
int fail(int code, std::string text) {
  for (char& c : text) {
    if (c == '\n') c = ' ';
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  }
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0)
    text.pop_back();
  if (text.empty() || text.back() != '.') text += '.';
  std::fputs(("nonobtuse: " + text + "\n").c_str(), stderr);
  return code;
}

// The library's sentence names the least number already; if not, it is added.
std::string with_least(const TooFewVertices& error) {
  std::string text = error.what();
  const std::string least = std::to_string(error.least());
  if (error.least() <= 0 || text.find(least) != std::string::npos) return text;
  if (!text.empty() && text.back() == '.') text.pop_back();
  return text + " (the least number reached is " + least + ")";
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int code = run_command(argc, argv);
    return std::fflush(stdout) == 0 ? code : fail(kBadUsage, "cannot write to standard output");
  } catch (const UsageError& error) {
    return fail(kBadUsage, error.what());
  } catch (const OutputError& error) {
    return fail(kBadUsage, error.what());
  } catch (const TooFewVertices& error) {
    return fail(kBadInput, with_least(error));
  } catch (const InvalidInput& error) {
    return fail(kBadInput, error.what());
  } catch (const IoError& error) {
    return fail(kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kInternal, "out of memory");
  } catch (const std::exception& error) {
    return fail(kInternal, std::string("internal error: ") + error.what());
  } catch (...) {
    return fail(kInternal, "internal error");
  }
}
