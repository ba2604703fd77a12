// The one call, with progress and Ctrl-C.
#include "nonobtuse/remesh.h"

#include <nanobind/stl/string.h>

#include <chrono>
#include <optional>
#include <string>

#include "bindings.h"

namespace nonobtuse::python {
namespace {

// Hears the progress of a call: looks for signals, tells the user's callback, and keeps what either
// raised. At most every 20 ms, so that the GIL is not asked for in vain, and when a stage begins.
class Watcher {
 public:
  explicit Watcher(nb::object callback) : callback_(std::move(callback)) {}

  // Called without the GIL. False: stop.
  bool hear(const Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    if (progress.stage == stage_ && now - heard_ < std::chrono::milliseconds(20)) return true;
    stage_ = progress.stage;
    heard_ = now;
    const nb::gil_scoped_acquire acquire;
    if (!look_for_signals()) return false;
    try {
      if (callback_.is_none()) return true;
      return goes_on(callback_(stage_, progress.fraction, message_of(progress)));
    } catch (nb::python_error& error) {
      error_ = nb::borrow(error.value());
      return false;
    }
  }

  // With the GIL. False: stop. Once more at the end, or a late Ctrl-C would cost the result.
  bool look_for_signals() {
    if (PyErr_CheckSignals() == 0) return true;
    const nb::python_error error;  // takes what was raised
    if (!failed()) error_ = nb::borrow(error.value());
    return false;
  }

  [[nodiscard]] bool failed() const { return error_.is_valid(); }
  [[nodiscard]] nb::object error() const { return failed() ? error_ : nb::none(); }

 private:
  static std::string message_of(const Progress& progress) {
    if (!progress.message.empty() || progress.obtuse < 0) return std::string(progress.message);
    return std::to_string(progress.obtuse) + " obtuse triangles";
  }

  // Only a false truth value stops, numpy's too; None or a number, as of a callback that returns
  // whatever its last call did, does not.
  static bool goes_on(const nb::object& answer) {
    const bool truth_value = PyBool_Check(answer.ptr()) != 0 ||
                             std::string(Py_TYPE(answer.ptr())->tp_name).starts_with("numpy.bool");
    if (!truth_value) return true;
    const int truth = PyObject_IsTrue(answer.ptr());
    if (truth < 0) throw nb::python_error();
    return truth == 1;
  }

  nb::object callback_;
  nb::object error_;
  std::string stage_;
  std::chrono::steady_clock::time_point heard_;
};

// What a call gives; the input in full only if it was repaired.
struct Outcome {
  std::vector<Repair> noted;  // repairs, and what is unusual but kept
  bool mended = false;
  TriangleMesh repaired;
  MeshAttributes attributes;  // of the result
  AngleQuality before;
  RemeshResult result;
};

Outcome clean_and_remesh(const TriangleMesh& given, MeshAttributes attributes, bool clean_first,
                         const RemeshOptions& options, const Context& context,
                         const Watcher& watcher) {
  Outcome outcome;
  const TriangleMesh* input = &given;
  if (clean_first) {
    CleanResult cleaned = clean(given, attributes);
    outcome.noted = noted(cleaned);
    outcome.mended = !cleaned.repairs.empty();
    if (outcome.mended) {
      outcome.repaired = std::move(cleaned.mesh);
      attributes = std::move(cleaned.attributes);
      input = &outcome.repaired;
    }
  }
  try {
    outcome.result = remesh(*input, options, context);
    if (!attributes.empty())
      outcome.attributes = transfer_attributes(*input, attributes, outcome.result);
  } catch (...) {
    if (!watcher.failed()) throw;
    outcome.result.status = Status::Cancelled;  // what was raised in Python comes first
  }
  outcome.before = measure_angles(*input);
  return outcome;
}

const char* name_of(Status status) {
  switch (status) {
    case Status::Converged:
      return "converged";
    case Status::AnglesRemain:
      return "angles_remain";
    case Status::Cancelled:
      return "cancelled";
  }
  return "";
}

Method method_of(const std::string& name) {
  if (name == "cvt") return Method::Cvt;
  if (name == "cvt-fs") return Method::CvtFs;
  if (name == "cvt-nob") return Method::CvtNob;
  return Method::Default;  // the Python side has checked the name
}

Sizing sizing_of(const std::string& name) {
  if (name == "lfs") return Sizing::LocalFeatureSize;
  if (name == "curvature") return Sizing::Curvature;
  if (name == "given") return Sizing::Given;
  return Sizing::Uniform;  // likewise
}

Features features_of(const std::string& name) {
  if (name == "none") return Features::None;
  if (name == "dihedral") return Features::Dihedral;
  if (name == "given") return Features::Given;
  return Features::Auto;  // likewise
}

nb::dict to_dict(const SizeRatio& ratio) {
  nb::dict d;
  d["median"] = ratio.median;
  d["percentile_5"] = ratio.percentile_5;
  d["percentile_95"] = ratio.percentile_95;
  return d;
}

nb::list history_list(const std::vector<IterationRecord>& history) {
  nb::list list;
  for (const IterationRecord& record : history) {
    nb::dict entry;
    entry["stage"] = record.stage;
    entry["iteration"] = record.iteration;
    entry["energy"] = record.energy;
    entry["obtuse"] = record.obtuse;
    entry["small"] = record.small;
    list.append(entry);
  }
  return list;
}

nb::dict to_dict(Outcome&& outcome, const nb::object& error) {
  RemeshResult& result = outcome.result;
  nb::list stages;
  for (const StageTime& stage : result.stages) {
    nb::dict entry;
    entry["stage"] = stage.stage;
    entry["seconds"] = stage.seconds;
    stages.append(entry);
  }
  nb::dict d;
  d["vertices"] = array_of(std::move(result.mesh.vertices));
  d["faces"] = array_of(std::move(result.mesh.triangles));
  d["source_triangle"] = array_of(std::move(result.source_triangle));
  d["barycentric"] = array_of(std::move(result.barycentric));
  d["feature_edges"] = array_of(std::move(result.feature_edges));
  nb::list corners;
  for (const NarrowCorner& corner : result.narrow_corners) {
    nb::dict entry;
    entry["vertex"] = corner.vertex;
    entry["input_angle"] = corner.input_angle;
    entry["reached_angle"] = corner.reached_angle;
    corners.append(entry);
  }
  d["narrow_corners"] = corners;
  d["parts_without_features"] = result.parts_without_features;
  d["status"] = name_of(result.status);
  d["certificate"] = to_tuple(std::move(result.certificate));
  d["goal"] = to_tuple(std::move(result.goal));
  d["after"] = angles_dict(result.angles);
  d["before"] = angles_dict(outcome.before);
  d["stages"] = stages;
  d["size_ratio"] = to_dict(result.size_ratio);
  d["max_error"] = result.max_error;
  d["history"] = history_list(result.history);
  d["repairs"] = to_list(outcome.noted);
  d["repaired"] = outcome.mended ? nb::object(to_tuple(std::move(outcome.repaired), outcome.noted))
                                 : nb::none();
  d["attributes"] = to_tuple(std::move(outcome.attributes));
  d["error"] = error;
  return d;
}

nb::dict remesh_arrays(const VertexArray& vertices, const FaceArray& faces, Index count,
                       double edge_length, double relative_edge_length, const std::string& method,
                       const std::string& sizing, const LengthArray& target_lengths,
                       double gradation, double max_error, double relative_max_error,
                       const std::string& features, double feature_angle,
                       const EdgeArray& feature_edges, const std::string& boundary,
                       double min_angle, double max_angle, bool on_surface, double penalty,
                       double normal_weight, int iterations, bool history, std::uint64_t seed,
                       int threads, nb::object progress, bool clean_first,
                       const nb::tuple& attributes_given) {
  const TriangleMesh given = mesh_of(vertices, faces);
  MeshAttributes attributes = attributes_of(attributes_given);
  RemeshOptions options;
  options.vertices = count;
  options.edge_length = edge_length;
  options.relative_edge_length = relative_edge_length;
  options.method = method_of(method);
  options.sizing = sizing_of(sizing);
  options.target_lengths.assign(target_lengths.data(),
                                target_lengths.data() + target_lengths.shape(0));
  options.gradation = gradation;
  options.max_error = max_error;
  options.relative_max_error = relative_max_error;
  options.features = features_of(features);
  options.feature_angle = feature_angle;
  options.feature_edges = rows_of<std::array<Index, 2>>(feature_edges);
  options.boundary = boundary == "freeze" ? Boundary::Freeze : Boundary::Resample;
  options.min_angle = min_angle;
  options.max_angle = max_angle;
  options.on_surface = on_surface;
  options.penalty = penalty;
  options.normal_weight = normal_weight;
  options.iterations = iterations;
  options.history = history;
  options.seed = seed;
  Watcher watcher(std::move(progress));
  Context context;
  context.threads = threads;
  context.progress = [&watcher](const Progress& p) { return watcher.hear(p); };
  Outcome outcome;
  {
    const nb::gil_scoped_release release;
    outcome =
        clean_and_remesh(given, std::move(attributes), clean_first, options, context, watcher);
  }
  watcher.look_for_signals();
  return to_dict(std::move(outcome), watcher.error());
}

}  // namespace

void bind_remesh(nb::module_& module) {
  module.def("remesh", remesh_arrays, nb::arg(), nb::arg(), nb::kw_only(), nb::arg("vertices"),
             nb::arg("edge_length"), nb::arg("relative_edge_length"), nb::arg("method"),
             nb::arg("sizing"), nb::arg("target_lengths"), nb::arg("gradation"),
             nb::arg("max_error"), nb::arg("relative_max_error"), nb::arg("features"),
             nb::arg("feature_angle"), nb::arg("feature_edges"), nb::arg("boundary"),
             nb::arg("min_angle"), nb::arg("max_angle"), nb::arg("on_surface"), nb::arg("penalty"),
             nb::arg("normal_weight"), nb::arg("iterations"), nb::arg("history"), nb::arg("seed"),
             nb::arg("threads"), nb::arg("progress").none(), nb::arg("clean"),
             nb::arg("attributes"));
}

}  // namespace nonobtuse::python
