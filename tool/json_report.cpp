#include "json_report.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "table.h"

namespace nonobtuse::tool {
namespace {

Json triangle_list(const std::vector<Index>& triangles, const TriangleMesh& mesh, Index worst) {
  Json list = Json::array();
  const std::size_t count = std::min(triangles.size(), static_cast<std::size_t>(worst));
  for (std::size_t k = 0; k < count; ++k) {
    const TriangleAngles angles = angles_of(mesh, triangles[k]);
    list.push_back({{"triangle", triangles[k]},
                    {"smallest_angle", angles.smallest},
                    {"largest_angle", angles.largest}});
  }
  return list;
}

const char* name_of(Method method) {
  switch (method) {
    case Method::Default:
      return "default";
    case Method::Cvt:
      return "cvt";
    case Method::CvtFs:
      return "cvt-fs";
    case Method::CvtNob:
      return "cvt-nob";
  }
  return "";
}

const char* name_of(Features features) {
  switch (features) {
    case Features::Auto:
      return "auto";
    case Features::None:
      return "none";
    case Features::Dihedral:
      return "dihedral";
    case Features::Given:
      return "given";
  }
  return "";
}

const char* name_of(Sizing sizing) {
  switch (sizing) {
    case Sizing::Uniform:
      return "uniform";
    case Sizing::LocalFeatureSize:
      return "lfs";
    case Sizing::Curvature:
      return "curvature";
    case Sizing::Given:
      return "given";
  }
  return "";
}

}  // namespace

Json to_json(const AngleQuality& angles) {
  return {{"triangles", angles.triangles},
          {"obtuse", angles.obtuse},
          {"small", angles.small},
          {"min_angle", angles.min_angle},
          {"max_angle", angles.max_angle},
          {"mean_min_angle", angles.mean_min_angle},
          {"quality_min", angles.quality_min},
          {"quality_mean", angles.quality_mean},
          {"percent_small", angles.percent_small},
          {"percent_obtuse", angles.percent_obtuse},
          {"percent_valence_567", angles.percent_valence_567}};
}

Json to_json(const Topology& topology) {
  return {{"vertices", topology.vertices},
          {"edges", topology.edges},
          {"triangles", topology.triangles},
          {"components", topology.components},
          {"boundary_loops", topology.boundary_loops},
          {"euler_characteristic", topology.euler_characteristic},
          {"nonmanifold_edges", topology.nonmanifold_edges},
          {"nonmanifold_vertices", topology.nonmanifold_vertices},
          {"oriented", topology.oriented}};
}

Json to_json(const SurfaceDistance& distance) {
  return {{"diagonal", distance.diagonal},
          {"hausdorff", distance.hausdorff},
          {"rms", distance.rms},
          {"hausdorff_to_reference", distance.hausdorff_to_reference},
          {"hausdorff_from_reference", distance.hausdorff_from_reference},
          {"rms_to_reference", distance.rms_to_reference},
          {"rms_from_reference", distance.rms_from_reference}};
}

Json to_json(const QualityReport& report, bool with_reference) {
  Json json{{"angles", to_json(report.angles)},
            {"topology", to_json(report.topology)},
            {"self_intersections", report.self_intersections}};
  if (with_reference) json["flipped"] = report.flipped;
  if (report.distance) json["distance"] = to_json(*report.distance);
  return json;
}

Json to_json(const Certificate& certificate, const TriangleMesh& mesh, Index worst) {
  return {{"min_angle", certificate.bounds.min_angle},
          {"max_angle", certificate.bounds.max_angle},
          {"certified", certificate.certified},
          {"triangles", certificate.triangles},
          {"too_large", certificate.too_large.size()},
          {"too_small", certificate.too_small.size()},
          {"worst_too_large", triangle_list(certificate.too_large, mesh, worst)},
          {"worst_too_small", triangle_list(certificate.too_small, mesh, worst)}};
}

Json to_json(const std::vector<Repair>& repairs) {
  Json list = Json::array();
  for (const Repair& repair : repairs)
    list.push_back({{"what", repair.what}, {"count", repair.count}, {"first", repair.first}});
  return list;
}

Json to_json(const std::vector<StageTime>& stages) {
  Json list = Json::array();
  for (const StageTime& stage : stages)
    list.push_back({{"stage", stage.stage}, {"seconds", stage.seconds}});
  return list;
}

Json to_json(const std::vector<IterationRecord>& history) {
  Json list = Json::array();
  for (const IterationRecord& record : history)
    list.push_back({{"stage", record.stage},
                    {"iteration", record.iteration},
                    {"energy", record.energy},
                    {"obtuse", record.obtuse},
                    {"small", record.small}});
  return list;
}

Json to_json(const SizeRatio& ratio) {
  return {{"median", ratio.median},
          {"percentile_5", ratio.percentile_5},
          {"percentile_95", ratio.percentile_95}};
}

Json to_json(const std::vector<NarrowCorner>& corners) {
  Json list = Json::array();
  for (const NarrowCorner& corner : corners)
    list.push_back({{"vertex", corner.vertex},
                    {"input_angle", corner.input_angle},
                    {"reached_angle", corner.reached_angle}});
  return list;
}

Json to_json(const RemeshOptions& options) {
  return {{"vertices", options.vertices},
          {"edge_length", options.edge_length},
          {"relative_edge_length", options.relative_edge_length},
          {"method", name_of(options.method)},
          {"sizing", name_of(options.sizing)},
          {"features", name_of(options.features)},
          {"feature_angle", options.feature_angle},
          {"boundary", options.boundary == Boundary::Freeze ? "freeze" : "resample"},
          {"gradation", options.gradation},
          {"max_error", options.max_error},
          {"relative_max_error", options.relative_max_error},
          {"min_angle", options.min_angle},
          {"max_angle", options.max_angle},
          {"on_surface", options.on_surface},
          {"penalty", options.penalty},
          {"normal_weight", options.normal_weight},
          {"iterations", options.iterations},
          {"seed", options.seed}};
}

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace nonobtuse::tool
