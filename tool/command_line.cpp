#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "nonobtuse/version.h"
#include "remesh_options.h"

namespace nonobtuse::tool {
namespace {

constexpr std::array<std::string_view, 5> kCommands{"remesh", "measure", "certify", "convert",
                                                    "sample"};

constexpr const char* kAbout =
    "Remeshes a triangle surface so that no angle is 90 degrees or more and none is below 30,\n"
    "and proves it in exact arithmetic on the file it writes.\n";

constexpr const char* kExamples = R"(
Examples:
  nonobtuse bunny.stl -o out.obj                      as many vertices as the input has
  nonobtuse remesh in.obj -o out.ply --vertices 8000  exactly 8000 vertices
  nonobtuse in.obj -o out.obj --edge-length 1%        edges of 1 % of the bounding-box diagonal
  nonobtuse measure out.obj --against in.obj          every quality figure, and the distance
  nonobtuse certify out.obj                           exact: exit 0 only if every angle is in [30, 90)
  nonobtuse convert a.stl b.ply
  nonobtuse sample -o sample.obj                      a surface of genus 3 to try things on

'nonobtuse COMMAND --help' tells the options of a command; 'remesh' may be left out.

Files: OBJ, OFF, PLY (ascii, binary) and STL (ascii, binary), read by content, written by suffix.

Exit codes:
  0  done and certified
  1  done, but some angle is outside the bounds asked for (the mesh is written, the report says where)
  2  bad usage, or the output cannot be written
  3  bad input (also: the topology needs more vertices; the message says how many)
  4  cancelled with Ctrl-C (the best valid mesh so far is written)
  5  internal error
)";

constexpr const char* kRemeshFooter = R"(
The result has exactly the vertices asked for and the components, Euler characteristic and boundary
loops of the input. Ctrl-C writes the best valid mesh so far and exits with 4; a second one ends at
once. Exit 0 means that every angle is in [min-angle, max-angle), exactly, in the written file.
)";

std::string lower_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

// Found out before any work is done.
void check_output(const OutputOptions& output) {
  const std::string suffix = lower_suffix(output.path);
  if (suffix != ".obj" && suffix != ".off" && suffix != ".ply" && suffix != ".stl")
    throw UsageError(fmt::format(
        "the format of the output '{}' is unknown: its name must end in .obj, .off, .ply or .stl",
        output.path));
  const std::filesystem::path folder = std::filesystem::path(output.path).parent_path();
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    throw UsageError(fmt::format("the folder of the output '{}' does not exist", output.path));
  if (std::filesystem::is_directory(output.path, error))
    throw UsageError(fmt::format("the output '{}' is a folder, not a file", output.path));
}

void add_output(CLI::App& command, OutputOptions& output) {
  command.add_option("-o,--output", output.path, "File to write: .obj, .off, .ply or .stl")
      ->required()
      ->type_name("FILE");
  command.add_flag("--ascii", output.ascii, "Write PLY and STL as text instead of binary");
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads; 0 = all cores. The result is the same")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str();
}

// Everything a command line can fill in, before we know which command it names.
struct Draft {
  RemeshDraft remesh;
  MeasureCommand measure;
  CertifyCommand certify;
  ConvertCommand convert;
  SampleCommand sample;
};

void add_remesh(CLI::App& app, RemeshDraft& draft) {
  CLI::App& command = *app.add_subcommand("remesh", "Remesh a surface (the word may be left out)");
  command.footer(kRemeshFooter);
  command.add_option("input", draft.command.input, "Mesh to read")->required()->type_name("FILE");
  add_output(command, draft.command.output);
  add_threads(command, draft.command.threads);
  add_remesh_options(command, draft);
}

void add_measure(CLI::App& app, MeasureCommand& c) {
  CLI::App& command = *app.add_subcommand(
      "measure", "Print angles, shape, valence, topology and self-intersections of a mesh");
  command.add_option("input", c.input, "Mesh to measure")->required()->type_name("FILE");
  command.add_option("--against", c.reference, "Also the two-sided distance to this mesh")
      ->type_name("FILE");
  add_threads(command, c.threads);
  command.add_flag("--json", c.json, "Print JSON (docs/json.md)");
}

void add_certify(CLI::App& app, CertifyCommand& c) {
  CLI::App& command = *app.add_subcommand(
      "certify", "Decide exactly whether every angle is inside the bounds; exit 0 only if so");
  command.add_option("input", c.input, "Mesh to certify")->required()->type_name("FILE");
  command.add_option("--min-angle", c.bounds.min_angle, "Every angle at least this, degrees")
      ->type_name("DEG")
      ->capture_default_str();
  command.add_option("--max-angle", c.bounds.max_angle, "Every angle below this, degrees")
      ->type_name("DEG")
      ->capture_default_str();
  command.add_option("--worst", c.worst, "How many of the worst triangles to name")
      ->check(CLI::Range(0, 1'000'000))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--json", c.json, "Print JSON (docs/json.md)");
}

void add_convert(CLI::App& app, ConvertCommand& c) {
  CLI::App& command = *app.add_subcommand(
      "convert",
      "Write a mesh in another format, coordinates kept; attributes where it holds them");
  command.add_option("input", c.input, "Mesh to read")->required()->type_name("FILE");
  command.add_option("output", c.output.path, "File to write: .obj, .off, .ply or .stl")
      ->required()
      ->type_name("FILE");
  command.add_flag("--ascii", c.output.ascii, "Write PLY and STL as text instead of binary");
}

void add_sample(CLI::App& app, SampleCommand& c) {
  CLI::App& command = *app.add_subcommand(
      "sample", "Write a surface of genus 3 from marching cubes, full of bad triangles");
  add_output(command, c.output);
  command.add_option("--resolution", c.resolution, "Grid cells along each side")
      ->check(CLI::Range(16, 1024))
      ->type_name("N")
      ->capture_default_str();
}

// `nonobtuse in.stl -o out.obj` means `nonobtuse remesh in.stl -o out.obj`.
std::vector<std::string> with_command(int argc, const char* const* argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty()) throw UsageError("say what to remesh; 'nonobtuse --help' tells how");
  const std::string& first = arguments.front();
  if (first == "--help" || first == "-h" || first == "--version") return arguments;
  if (std::find(kCommands.begin(), kCommands.end(), first) != kCommands.end()) return arguments;
  std::error_code error;
  const bool looks_like_a_word = first.find_first_of("./-") == std::string::npos;
  if (looks_like_a_word && !std::filesystem::exists(first, error))
    throw UsageError(fmt::format(
        "'{}' is neither a command (remesh, measure, certify, convert, sample) nor a file", first));
  arguments.insert(arguments.begin(), "remesh");
  return arguments;
}

void check_bounds(double min_angle, double max_angle) {
  if (!(min_angle >= 0 && min_angle <= 60))
    throw UsageError(fmt::format("--min-angle must be between 0 and 60, not {}", min_angle));
  if (!(max_angle > 60 && max_angle <= 90))
    throw UsageError(fmt::format("--max-angle must be above 60 and at most 90, not {}", max_angle));
}

CommandLine checked(const CLI::App& app, Draft& draft) {
  CommandLine line;
  if (app.got_subcommand("remesh")) {
    RemeshCommand command = checked(draft.remesh);
    check_bounds(command.options.min_angle, command.options.max_angle);
    check_output(command.output);
    line.remesh = std::move(command);
  } else if (app.got_subcommand("measure")) {
    line.measure = draft.measure;
  } else if (app.got_subcommand("certify")) {
    check_bounds(draft.certify.bounds.min_angle, draft.certify.bounds.max_angle);
    line.certify = draft.certify;
  } else if (app.got_subcommand("convert")) {
    check_output(draft.convert.output);
    line.convert = draft.convert;
  } else {
    check_output(draft.sample.output);
    line.sample = draft.sample;
  }
  return line;
}

// The command line in one line, for a shell.
std::string as_typed(int argc, const char* const* argv) {
  std::string text = "nonobtuse";
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 ||
             std::string_view("-_./,:=+%@").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (plain) {
      text += fmt::format(" {}", word);
      continue;
    }
    text += " '";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += "'";
  }
  return text;
}

// CLI11's sentence in our form: lower case, no full stop, one line.
std::string sentence_of(const CLI::ParseError& error) {
  std::string text = error.what();
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])) != 0)
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text + "; see --help";
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app(kAbout, "nonobtuse");
  app.footer(kExamples);
  app.require_subcommand(1);
  app.set_version_flag("--version", "nonobtuse " NONOBTUSE_VERSION);
  Draft draft;
  add_remesh(app, draft.remesh);
  add_measure(app, draft.measure);
  add_certify(app, draft.certify);
  add_convert(app, draft.convert);
  add_sample(app, draft.sample);
  std::vector<std::string> arguments = with_command(argc, argv);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  CommandLine line;
  try {
    app.parse(arguments);
    line = checked(app, draft);
    if (line.remesh) line.remesh->command_line = as_typed(argc, argv);
    return line;
  } catch (const CLI::CallForHelp&) {
    line.message = app.help();
  } catch (const CLI::CallForVersion& version) {
    line.message = std::string(version.what()) + "\n";
  } catch (const CLI::ParseError& error) {
    throw UsageError(sentence_of(error));
  }
  return line;
}

}  // namespace nonobtuse::tool
