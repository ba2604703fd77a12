#include "remesh_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "report_file.h"

namespace nonobtuse::tool {
namespace {

void check_report(const std::string& path) {
  if (path.empty()) return;
  if (!is_html(path) && !is_json(path))
    throw UsageError(fmt::format("the name of the report '{}' must end in .html or .json", path));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    throw UsageError(fmt::format("the folder of the report '{}' does not exist", path));
  if (std::filesystem::is_directory(path, error))
    throw UsageError(fmt::format("the report '{}' is a folder, not a file", path));
}

double parse_number(const std::string& text, const std::string& whole, const char* option) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || value <= 0)
    throw UsageError(fmt::format(
        "{} must be a positive length such as 0.5, or 1% of the bounding-box diagonal, not '{}'",
        option, whole));
  return value;
}

void set_max_error(const std::string& text, RemeshOptions& options) {
  if (!text.empty() && text.back() == '%') {
    options.relative_max_error =
        parse_number(text.substr(0, text.size() - 1), text, "--max-error") / 100;
  } else {
    options.max_error = parse_number(text, text, "--max-error");
  }
}

void set_edge_length(const std::string& text, RemeshOptions& options) {
  if (!text.empty() && text.back() == '%') {
    options.relative_edge_length =
        parse_number(text.substr(0, text.size() - 1), text, "--edge-length") / 100;
  } else {
    options.edge_length = parse_number(text, text, "--edge-length");
  }
}

Method parse_method(const std::string& text) {
  if (text == "default") return Method::Default;
  if (text == "cvt") return Method::Cvt;
  if (text == "cvt-fs") return Method::CvtFs;
  if (text == "cvt-nob") return Method::CvtNob;
  throw UsageError(fmt::format("--method must be default, cvt, cvt-fs or cvt-nob, not '{}'", text));
}

// A file may be called like one of the words if its path says so: ./uniform.
void set_sizing(const std::string& text, RemeshCommand& command) {
  RemeshOptions& options = command.options;
  if (text == "uniform") {
    options.sizing = Sizing::Uniform;
  } else if (text == "lfs") {
    options.sizing = Sizing::LocalFeatureSize;
  } else if (text == "curvature") {
    options.sizing = Sizing::Curvature;
  } else {
    std::error_code error;
    if (!std::filesystem::is_regular_file(text, error))
      throw UsageError(fmt::format(
          "--sizing must be uniform, lfs, curvature or a file of lengths, not '{}'", text));
    options.sizing = Sizing::Given;
    command.sizes = text;
  }
  if (!(options.gradation > 0)) throw UsageError("--gradation must be positive");
}

// Likewise: ./auto is a file.
void set_features(const std::string& text, RemeshCommand& command) {
  RemeshOptions& options = command.options;
  char* end = nullptr;
  const double degrees = std::strtod(text.c_str(), &end);
  if (text == "auto") {
    options.features = Features::Auto;
  } else if (text == "none") {
    options.features = Features::None;
  } else if (!text.empty() && *end == '\0') {
    if (!(degrees > 0 && degrees <= 180))
      throw UsageError(fmt::format("--features must be an angle in (0, 180], not '{}'", text));
    options.features = Features::Dihedral;
    options.feature_angle = degrees;
  } else {
    std::error_code error;
    if (!std::filesystem::is_regular_file(text, error))
      throw UsageError(fmt::format(
          "--features must be auto, none, an angle in degrees or a file of edges, not '{}'", text));
    options.features = Features::Given;
    command.feature_edges = text;
  }
}

Boundary parse_boundary(const std::string& text) {
  if (text == "resample") return Boundary::Resample;
  if (text == "freeze") return Boundary::Freeze;
  throw UsageError(fmt::format("--boundary must be resample or freeze, not '{}'", text));
}

void add_size_options(CLI::App& command, RemeshDraft& draft) {
  RemeshOptions& options = draft.command.options;
  command.option_defaults()->group("Size of the triangles");
  CLI::Option* vertices =
      command
          .add_option("--vertices", options.vertices,
                      "Vertices of the result, exactly; default: as many as the input has")
          ->check(CLI::Range(1, 100'000'000))
          ->type_name("N");
  command
      .add_option("--edge-length", draft.edge_length,
                  "Instead of --vertices: target edge length, or 1% of the bounding-box diagonal")
      ->excludes(vertices)
      ->type_name("L");
  command
      .add_option("--sizing", draft.sizing,
                  "How the edge length varies: uniform; lfs: finer at small features; curvature: "
                  "finer where it bends; or a file with a target edge length per input vertex, one "
                  "number a line")
      ->type_name("uniform|lfs|curvature|FILE")
      ->capture_default_str();
  command
      .add_option("--gradation", options.gradation,
                  "How fast the target edge length may grow along the surface, per length")
      ->type_name("G")
      ->capture_default_str();
  command
      .add_option("--max-error", draft.max_error,
                  "Add vertices until the two-sided distance to the input, as measured, is at most "
                  "this length, or 0.2% of the bounding-box diagonal")
      ->type_name("E");
}

void add_feature_options(CLI::App& command, RemeshDraft& draft) {
  command.option_defaults()->group("Creases and boundaries");
  command
      .add_option(
          "--features", draft.features,
          "Edges of the input that stay edges: auto: sharp creases, none on smooth surfaces; "
          "none; DEG: all edges at which the surface turns by so many degrees; or a file "
          "with two vertex numbers (from 0) per edge, one edge a line. Boundaries always do")
      ->type_name("auto|none|DEG|FILE")
      ->capture_default_str();
  command
      .add_option(
          "--boundary", draft.boundary,
          "Boundary vertices: resample: along the boundary curve, its corners kept; freeze: "
          "exactly those of the input")
      ->type_name("resample|freeze")
      ->capture_default_str();
  command.add_flag("--keep-seams", draft.command.keep_seams,
                   "Keep the seams of a texture and the borders between face labels as edges");
}

void add_angle_options(CLI::App& command, RemeshOptions& options) {
  command.option_defaults()->group("Angles and distance");
  command.add_option("--min-angle", options.min_angle, "Every angle at least this, degrees")
      ->type_name("DEG")
      ->capture_default_str();
  command.add_option("--max-angle", options.max_angle, "Every angle below this, degrees")
      ->type_name("DEG")
      ->capture_default_str();
  command.add_flag("--on-surface", options.on_surface,
                   "Keep every vertex on the input, instead of at the offset that minimises the "
                   "distance");
}

void add_method_options(CLI::App& command, RemeshDraft& draft) {
  RemeshOptions& options = draft.command.options;
  command.option_defaults()->group("Method");
  command
      .add_option(
          "--method", draft.method,
          "default: CVT, then refinement on the mesh; the methods of Yan & Wonka 2016: cvt: "
          "CVT alone; cvt-fs: then with the feature-sensitive energy; cvt-nob: with the "
          "short-dual penalty, first without and then with that energy")
      ->type_name("default|cvt|cvt-fs|cvt-nob")
      ->capture_default_str();
  command
      .add_option("--normal-weight", options.normal_weight,
                  "Weight s of the normal part in the feature-sensitive energy of cvt-fs and "
                  "cvt-nob; 1 leaves it out")
      ->check(CLI::Range(1.0, 1e6))
      ->type_name("S")
      ->capture_default_str();
  command
      .add_option("--iterations", options.iterations,
                  "L-BFGS iterations of every stage of cvt, cvt-fs and cvt-nob; default: 40")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  command.add_option("--penalty", options.penalty, "Weight lambda of the penalty of cvt-nob")
      ->check(CLI::NonNegativeNumber)
      ->type_name("LAMBDA")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed of the random start")
      ->type_name("N")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const bool fine = !text.empty() && text.size() < 20 &&
                              text.find_first_not_of("0123456789") == std::string::npos;
            return fine ? std::string()
                        : "it must be a whole number of at most 19 digits, not '" + text + "'";
          },
          ""))
      ->capture_default_str();
}

void add_report_options(CLI::App& command, RemeshCommand& c) {
  command.option_defaults()->group("What is printed");
  command.add_flag("--no-distance", c.no_distance,
                   "Do not measure the distance between input and result for the table");
  command
      .add_option("--report", c.report,
                  "Also write a report: .html, one page with both surfaces, figures and places; "
                  ".json, its data (docs/json.md)")
      ->type_name("FILE");
  command.add_flag("--quiet", c.quiet, "Print nothing but errors");
  command.add_flag("--progress", c.progress,
                   "Report progress on stderr even if that is no terminal");
  command.add_flag("--json", c.json, "Print a report as JSON (docs/json.md) instead of the table");
  command.add_flag("--history", c.options.history,
                   "With --json: energy and number of bad triangles, iteration by iteration");
}

}  // namespace

void add_remesh_options(CLI::App& command, RemeshDraft& draft) {
  add_size_options(command, draft);
  add_feature_options(command, draft);
  add_angle_options(command, draft.command.options);
  add_method_options(command, draft);
  add_report_options(command, draft.command);
}

RemeshCommand checked(const RemeshDraft& draft) {
  RemeshCommand command = draft.command;
  RemeshOptions& options = command.options;
  if (draft.edge_length) set_edge_length(*draft.edge_length, options);
  if (draft.max_error) set_max_error(*draft.max_error, options);
  options.method = parse_method(draft.method);
  set_sizing(draft.sizing, command);
  set_features(draft.features, command);
  if (command.keep_seams && options.features == Features::None)
    throw UsageError("--keep-seams makes features of seams; --features none forbids any");
  options.boundary = parse_boundary(draft.boundary);
  if (options.iterations > 0 && options.method == Method::Default)
    throw UsageError("--iterations is for the methods cvt, cvt-fs and cvt-nob only");
  if (options.history && !command.json && command.report.empty())
    throw UsageError("--history adds to the JSON report: give --json or --report too");
  if (!command.report.empty()) options.history = true;
  if (options.min_angle == 60) throw UsageError("--min-angle must be below 60");
  check_report(command.report);
  return command;
}

}  // namespace nonobtuse::tool
