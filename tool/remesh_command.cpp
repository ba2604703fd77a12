// Read, clean, remesh, certify what will be in the file, write, report.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "commands.h"
#include "exit_code.h"
#include "interrupt.h"
#include "json_report.h"
#include "nonobtuse/io.h"
#include "nonobtuse/quality.h"
#include "nonobtuse/remesh.h"
#include "nonobtuse/version.h"
#include "progress_bar.h"
#include "report_file.h"
#include "table.h"

namespace nonobtuse::tool {
namespace {

constexpr Index kTrianglesNamed = 5;
constexpr Index kTrianglesListed = 1000;  // of each kind, in a report
// Above this many triangles, the distance would take longer than people wait for a table.
constexpr std::size_t kDistanceLimit = 400'000;

// What was done and how good it is.
struct Outcome {
  TriangleMesh input;
  MeshAttributes attributes;  ///< of the input
  std::vector<Repair> repairs;
  RemeshResult result;
  TriangleMesh written;  ///< the result as a reader of the file sees it
  Certificate goal;      ///< of `written`, against the bounds asked for
  Certificate promise;   ///< of `written`, against [30, 90)
  double seconds = 0;    ///< from the start until the certified file was written
  std::optional<SurfaceDistance> distance;
};

void read_clean(const std::string& path, Outcome& outcome) {
  ReadResult read = read_mesh(path);
  CleanResult cleaned = clean(read.mesh, read.attributes);
  outcome.repairs = std::move(read.repairs);
  outcome.repairs.insert(outcome.repairs.end(), cleaned.repairs.begin(), cleaned.repairs.end());
  outcome.repairs.insert(outcome.repairs.end(), cleaned.kept.begin(), cleaned.kept.end());
  outcome.input = std::move(cleaned.mesh);
  outcome.attributes = std::move(cleaned.attributes);
}

// One positive number for each vertex, separated by white space.
std::vector<double> read_lengths(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw IoError(path + ": cannot be opened.");
  std::vector<double> lengths;
  std::string word;
  while (file >> word) {
    char* end = nullptr;
    lengths.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0')
      throw IoError(fmt::format("{}: entry {}: '{}' is not a number.", path, lengths.size(), word));
  }
  return lengths;
}

// Two vertex numbers, counted from 0, for each edge, separated by white space.
std::vector<std::array<Index, 2>> read_edges(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw IoError(path + ": cannot be opened.");
  std::vector<Index> numbers;
  std::string word;
  while (file >> word) {
    char* end = nullptr;
    const long value = std::strtol(word.c_str(), &end, 10);
    if (*end != '\0' || value < 0 || value > 2147483647)
      throw IoError(
          fmt::format("{}: entry {}: '{}' is no vertex number.", path, numbers.size() + 1, word));
    numbers.push_back(static_cast<Index>(value));
  }
  if (numbers.size() % 2 != 0)
    throw IoError(path + ": the last edge has one vertex only; two numbers make an edge.");
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t i = 0; i < numbers.size(); i += 2) edges.push_back({numbers[i], numbers[i + 1]});
  return edges;
}

RemeshResult remesh_with_progress(const RemeshCommand& command, const TriangleMesh& input,
                                  const MeshAttributes& attributes,
                                  const std::atomic<bool>& interrupted) {
  const ProgressStyle style = progress_style(command.progress, command.quiet);
  ProgressBar bar(style);
  Context context;
  context.threads = command.threads;
  context.cancel = &interrupted;
  if (style != ProgressStyle::None)
    context.progress = [&bar](const Progress& progress) {
      bar.show(progress);
      return true;
    };
  RemeshOptions options = command.options;
  if (!command.sizes.empty()) options.target_lengths = read_lengths(command.sizes);
  if (!command.feature_edges.empty()) options.feature_edges = read_edges(command.feature_edges);
  if (command.keep_seams)
    for (const auto& edge : attribute_borders(input, attributes))
      options.feature_edges.push_back(edge);
  return remesh(input, options, context);
}

int exit_code_of(const Outcome& outcome) {
  if (outcome.result.status == Status::Cancelled) return kCancelled;
  return certified_but_for_narrow_corners(outcome.written, outcome.goal,
                                          outcome.result.narrow_corners)
             ? kDone
             : kAnglesRemain;
}

const char* status_name(int code) {
  if (code == kCancelled) return "cancelled";
  return code == kDone ? "converged" : "angles_remain";
}

// At most `named` triangles of each kind are named.
Json json_of(const RemeshCommand& command, const Outcome& outcome, int code, Index named) {
  Json json{{"command", "remesh"},
            {"input", command.input},
            {"output", command.output.path},
            {"status", status_name(code)},
            {"exit_code", code},
            {"options", to_json(command.options)},
            {"repairs", to_json(outcome.repairs)},
            {"before", to_json(measure_angles(outcome.input))},
            {"before_vertices", outcome.input.vertices.size()},
            {"after", to_json(measure_angles(outcome.written))},
            {"after_vertices", outcome.written.vertices.size()},
            {"size_ratio", to_json(outcome.result.size_ratio)},
            {"narrow_corners", to_json(outcome.result.narrow_corners)},
            {"parts_without_features", outcome.result.parts_without_features},
            {"creases_given_up", outcome.result.creases_given_up},
            {"goal", to_json(outcome.goal, outcome.written, named)},
            {"promise", to_json(outcome.promise, outcome.written, named)},
            {"seconds", outcome.seconds},
            {"stages", to_json(outcome.result.stages)}};
  if (outcome.result.max_error > 0) json["max_error"] = outcome.result.max_error;
  if (command.options.history) json["history"] = to_json(outcome.result.history);
  if (outcome.distance) json["distance"] = to_json(*outcome.distance);
  return json;
}

// All of the above, and what a page needs to show it.
Json full_report(const RemeshCommand& command, const Outcome& outcome, int code) {
  Json json{{"version", NONOBTUSE_VERSION}, {"command_line", command.command_line}};
  json.update(json_of(command, outcome, code, kTrianglesListed));
  json["before_topology"] = to_json(measure_topology(outcome.input));
  json["after_topology"] = to_json(measure_topology(outcome.written));
  Context context;
  context.threads = command.threads;
  std::vector<double> to_result, to_input;
  if (outcome.distance) {
    json["self_intersections"] = count_self_intersections(outcome.written, context);
    to_result = vertex_distances(outcome.input, outcome.written, context);
    to_input = vertex_distances(outcome.written, outcome.input, context);
  }
  const Vec3 origin = middle_of(outcome.input);
  json["feature_edges"] = outcome.result.feature_edges;
  json["meshes"] = {{"before", packed_mesh(outcome.input, origin, to_result)},
                    {"after", packed_mesh(outcome.written, origin, to_input)}};
  return json;
}

// Corners of the input that no mesh can keep and yet have good angles.
void print_narrow_corners(const Outcome& outcome) {
  const std::vector<NarrowCorner>& corners = outcome.result.narrow_corners;
  if (corners.empty()) return;
  const bool narrow = std::all_of(corners.begin(), corners.end(),
                                  [](const NarrowCorner& c) { return c.input_angle < 30; });
  fmt::print("{} of the input {}, which any mesh keeps:\n",
             corners.size() == 1 ? "1 corner" : fmt::format("{} corners", corners.size()),
             narrow ? "have a face angle below 30 degrees"
                    : "leave no room between the edges of the boundary for angles in [30, 90)");
  for (std::size_t i = 0; i < corners.size() && i < kTrianglesNamed; ++i) {
    const Vec3& p = outcome.written.vertices[corners[i].vertex];
    fmt::print("  vertex {} at ({:.6g}, {:.6g}, {:.6g}): {:.4f} in the input, {:.4f} reached\n",
               corners[i].vertex, p.x, p.y, p.z, corners[i].input_angle, corners[i].reached_angle);
  }
  if (!outcome.goal.certified && exit_code_of(outcome) == kDone)
    fmt::print("every triangle outside the bounds touches one of them\n");
}

void print_table(const RemeshCommand& command, const Outcome& outcome) {
  const auto count = [](const TriangleMesh& m) { return static_cast<Index>(m.vertices.size()); };
  const Column before{"before", count(outcome.input), measure_angles(outcome.input), {}};
  const Column after{"after", count(outcome.written), measure_angles(outcome.written),
                     outcome.distance};
  fmt::print("{}{}\n", repairs_text(command.input, outcome.repairs),
             quality_table({before, after}));
  const SizeRatio& ratio = outcome.result.size_ratio;
  fmt::print("edge length over target: median {:.3f}, 90 % of all in {:.3f} .. {:.3f}\n",
             ratio.median, ratio.percentile_5, ratio.percentile_95);
  if (outcome.result.max_error > 0)
    fmt::print("distance to the input at most {:.4g}, as measured\n", outcome.result.max_error);
  const std::string& path = command.output.path;
  fmt::print("{}", certificate_text(path, outcome.written, outcome.goal, kTrianglesNamed));
  // A goal that was missed may still leave the promise kept.
  const CertificateBounds& goal = outcome.goal.bounds;
  if (!outcome.goal.certified && (goal.min_angle != 30 || goal.max_angle != 90))
    fmt::print("{}", certificate_text(path, outcome.written, outcome.promise, 0));
  print_narrow_corners(outcome);
  if (const double length = outcome.result.creases_given_up; length > 0)
    fmt::print(
        "creases of length {:.4g} were given up: others are nearer than an edge, and the vertices "
        "too "
        "few to keep both\n",
        length);
  if (const Index parts = outcome.result.parts_without_features; parts > 0)
    fmt::print(
        "{} meshed without creases and boundary curves: too few vertices to keep them apart\n",
        parts == 1 ? "1 connected component was" : fmt::format("{} components were", parts));
  if (outcome.result.status == Status::Cancelled) fmt::print("cancelled: the best mesh so far\n");
  if (!command.no_distance && !outcome.distance && outcome.result.status != Status::Cancelled)
    fmt::print(
        "distance not measured, for more than {} triangles in all: 'nonobtuse measure {} --against "
        "{}' does\n",
        kDistanceLimit, path, command.input);
  fmt::print("{} written, {:.2f} s from reading to the certified file\n", path, outcome.seconds);
}

}  // namespace

int run(const RemeshCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  const std::atomic<bool>& interrupted = catch_interrupts();
  Outcome outcome;
  read_clean(command.input, outcome);
  outcome.result = remesh_with_progress(command, outcome.input, outcome.attributes, interrupted);
  if (outcome.result.mesh.triangles.empty()) {
    fmt::print(stderr, "nonobtuse: cancelled before there was a mesh; nothing was written.\n");
    return kCancelled;
  }
  const WriteOptions write_options{!command.output.ascii};
  outcome.written = as_written(command.output.path, outcome.result.mesh, write_options);
  outcome.goal = certify(outcome.written, {command.options.min_angle, command.options.max_angle});
  outcome.promise = certify(outcome.written);
  MeshAttributes attributes;
  if (!outcome.attributes.empty())
    attributes = transfer_attributes(outcome.input, outcome.attributes, outcome.result);
  write_output(command.output, outcome.result.mesh, attributes);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const int code = exit_code_of(outcome);
  if (command.quiet && !command.json && command.report.empty()) return code;
  const std::size_t triangles = outcome.input.triangles.size() + outcome.written.triangles.size();
  if (!command.no_distance && code != kCancelled && triangles <= kDistanceLimit) {
    Context context;
    context.threads = command.threads;
    outcome.distance = measure_distance(outcome.written, outcome.input, context);
  }
  if (!command.report.empty()) write_report(command.report, full_report(command, outcome, code));
  if (command.json) {
    fmt::print("{}", dump(json_of(command, outcome, code, kTrianglesNamed)));
  } else if (!command.quiet) {
    print_table(command, outcome);
  }
  return code;
}

}  // namespace nonobtuse::tool
