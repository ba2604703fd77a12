// Measuring and certifying; the dictionaries are those of docs/json.md.
#include "nonobtuse/quality.h"

#include "bindings.h"

namespace nonobtuse::python {
namespace {

nb::dict to_dict(const Topology& topology) {
  nb::dict d;
  d["vertices"] = topology.vertices;
  d["edges"] = topology.edges;
  d["triangles"] = topology.triangles;
  d["components"] = topology.components;
  d["boundary_loops"] = topology.boundary_loops;
  d["euler_characteristic"] = topology.euler_characteristic;
  d["nonmanifold_edges"] = topology.nonmanifold_edges;
  d["nonmanifold_vertices"] = topology.nonmanifold_vertices;
  d["oriented"] = topology.oriented;
  return d;
}

nb::dict to_dict(const SurfaceDistance& distance) {
  nb::dict d;
  d["diagonal"] = distance.diagonal;
  d["hausdorff"] = distance.hausdorff;
  d["rms"] = distance.rms;
  d["hausdorff_to_reference"] = distance.hausdorff_to_reference;
  d["hausdorff_from_reference"] = distance.hausdorff_from_reference;
  d["rms_to_reference"] = distance.rms_to_reference;
  d["rms_from_reference"] = distance.rms_from_reference;
  return d;
}

nb::dict measure_arrays(const VertexArray& vertices, const FaceArray& faces,
                        const VertexArray& reference_vertices, const FaceArray& reference_faces,
                        bool with_reference, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const TriangleMesh reference = mesh_of(reference_vertices, reference_faces);
  QualityReport report;
  {
    const nb::gil_scoped_release release;
    Context context;
    context.threads = threads;
    report = measure(mesh, with_reference ? &reference : nullptr, context);
  }
  nb::dict d;
  d["vertices"] = mesh.vertices.size();
  d["angles"] = angles_dict(report.angles);
  d["topology"] = to_dict(report.topology);
  d["self_intersections"] = report.self_intersections;
  if (with_reference) d["flipped"] = report.flipped;
  if (report.distance) d["distance"] = to_dict(*report.distance);
  return d;
}

nb::object vertex_distances_arrays(const VertexArray& vertices, const FaceArray& faces,
                                   const VertexArray& reference_vertices,
                                   const FaceArray& reference_faces, int threads) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const TriangleMesh reference = mesh_of(reference_vertices, reference_faces);
  std::vector<double> distances;
  {
    const nb::gil_scoped_release release;
    Context context;
    context.threads = threads;
    distances = vertex_distances(mesh, reference, context);
  }
  return array_of(std::move(distances));
}

nb::dict topology_of(const VertexArray& vertices, const FaceArray& faces) {
  return to_dict(measure_topology(mesh_of(vertices, faces)));
}

nb::tuple certify_arrays(const VertexArray& vertices, const FaceArray& faces, double min_angle,
                         double max_angle) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  Certificate certificate;
  {
    const nb::gil_scoped_release release;
    certificate = certify(mesh, {min_angle, max_angle});
  }
  return to_tuple(std::move(certificate));
}

}  // namespace

nb::dict angles_dict(const AngleQuality& angles) {
  nb::dict d;
  d["triangles"] = angles.triangles;
  d["obtuse"] = angles.obtuse;
  d["small"] = angles.small;
  d["min_angle"] = angles.min_angle;
  d["max_angle"] = angles.max_angle;
  d["mean_min_angle"] = angles.mean_min_angle;
  d["quality_min"] = angles.quality_min;
  d["quality_mean"] = angles.quality_mean;
  d["percent_small"] = angles.percent_small;
  d["percent_obtuse"] = angles.percent_obtuse;
  d["percent_valence_567"] = angles.percent_valence_567;
  return d;
}

nb::tuple to_tuple(Certificate&& certificate) {
  return nb::make_tuple(certificate.bounds.min_angle, certificate.bounds.max_angle,
                        certificate.certified, certificate.triangles,
                        array_of(std::move(certificate.too_large)),
                        array_of(std::move(certificate.too_small)));
}

void bind_quality(nb::module_& module) {
  module.def("measure", measure_arrays);
  module.def("vertex_distances", vertex_distances_arrays);
  module.def("topology", topology_of);
  module.def("certify", certify_arrays);
}

}  // namespace nonobtuse::python
