// The small commands: measure, certify, convert, sample.
#include "commands.h"

#include <fmt/format.h>

#include <cstdio>

#include "exit_code.h"
#include "json_report.h"
#include "nonobtuse/io.h"
#include "nonobtuse/quality.h"
#include "nonobtuse/sample.h"
#include "table.h"

namespace nonobtuse::tool {

void write_output(const OutputOptions& output, const TriangleMesh& mesh,
                  const MeshAttributes& attributes) {
  try {
    write_mesh(output.path, mesh, attributes, WriteOptions{!output.ascii});
  } catch (const IoError& error) {
    throw OutputError(error.what());
  }
}

int run(const MeasureCommand& command) {
  const ReadResult read = read_mesh(command.input);
  Context context;
  context.threads = command.threads;
  const bool with_reference = !command.reference.empty();
  QualityReport report;
  if (with_reference) {
    const ReadResult reference = read_mesh(command.reference);
    report = measure(read.mesh, &reference.mesh, context);
  } else {
    report = measure(read.mesh, nullptr, context);
  }
  if (command.json) {
    Json json{{"command", "measure"}, {"input", command.input}};
    if (with_reference) json["against"] = command.reference;
    json["vertices"] = read.mesh.vertices.size();
    json["repairs"] = to_json(read.repairs);
    json.update(to_json(report, with_reference));
    fmt::print("{}", dump(json));
  } else {
    fmt::print("{}{}{}", repairs_text(command.input, read.repairs),
               quality_table({{"", static_cast<Index>(read.mesh.vertices.size()), report.angles,
                               report.distance}}),
               topology_table(report, with_reference));
  }
  return kDone;
}

int run(const CertifyCommand& command) {
  const ReadResult read = read_mesh(command.input);
  const Certificate certificate = certify(read.mesh, command.bounds);
  if (command.json) {
    Json json{{"command", "certify"}, {"input", command.input}};
    json.update(to_json(certificate, read.mesh, command.worst));
    fmt::print("{}", dump(json));
  } else {
    fmt::print("{}", certificate_text(command.input, read.mesh, certificate, command.worst));
  }
  return certificate.certified ? kDone : kAnglesRemain;
}

int run(const ConvertCommand& command) {
  const ReadResult read = read_mesh(command.input);
  write_output(command.output, read.mesh, read.attributes);
  fmt::print("{}{} written: {} vertices, {} triangles\n", repairs_text(command.input, read.repairs),
             command.output.path, read.mesh.vertices.size(), read.mesh.triangles.size());
  return kDone;
}

int run(const SampleCommand& command) {
  const TriangleMesh mesh = sample_surface(command.resolution);
  write_output(command.output, mesh);
  fmt::print("{} written: {} vertices, {} triangles\n", command.output.path, mesh.vertices.size(),
             mesh.triangles.size());
  return kDone;
}

}  // namespace nonobtuse::tool
