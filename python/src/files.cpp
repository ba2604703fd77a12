// Mesh files in and out, cleaning, the sample.
#include <nanobind/stl/string.h>

#include <string>

#include "bindings.h"
#include "nonobtuse/sample.h"

namespace nonobtuse::python {
namespace {

// A path is bytes (os.fsencode): file names need not be Unicode.
std::string path_of(const nb::bytes& path) { return {path.c_str(), path.size()}; }

nb::tuple read(const nb::bytes& path) {
  const std::string name = path_of(path);
  ReadResult read;
  {
    const nb::gil_scoped_release release;
    read = read_mesh(name);
  }
  return nb::make_tuple(to_tuple(std::move(read.mesh), read.repairs),
                        to_tuple(std::move(read.attributes)));
}

void write(const nb::bytes& path, const VertexArray& vertices, const FaceArray& faces,
           const nb::tuple& attributes_given, bool binary) {
  const std::string name = path_of(path);
  const TriangleMesh mesh = mesh_of(vertices, faces);
  const MeshAttributes attributes = attributes_of(attributes_given);
  const nb::gil_scoped_release release;
  write_mesh(name, mesh, attributes, {.binary = binary});
}

nb::tuple clean_arrays(const VertexArray& vertices, const FaceArray& faces) {
  const TriangleMesh mesh = mesh_of(vertices, faces);
  CleanResult cleaned;
  {
    const nb::gil_scoped_release release;
    cleaned = clean(mesh);
  }
  return to_tuple(std::move(cleaned.mesh), noted(cleaned));
}

nb::tuple sample(Index resolution) {
  TriangleMesh mesh;
  {
    const nb::gil_scoped_release release;
    mesh = sample_surface(resolution);
  }
  return to_tuple(std::move(mesh), {});
}

}  // namespace

std::vector<Repair> noted(const CleanResult& cleaned) {
  std::vector<Repair> all = cleaned.repairs;
  all.insert(all.end(), cleaned.kept.begin(), cleaned.kept.end());
  return all;
}

nb::list to_list(const std::vector<Repair>& repairs) {
  nb::list list;
  for (const Repair& repair : repairs) {
    nb::dict entry;
    entry["what"] = repair.what;
    entry["count"] = repair.count;
    entry["first"] = repair.first;
    list.append(entry);
  }
  return list;
}

nb::tuple to_tuple(TriangleMesh&& mesh, const std::vector<Repair>& repairs) {
  return nb::make_tuple(array_of(std::move(mesh.vertices)), array_of(std::move(mesh.triangles)),
                        to_list(repairs));
}

void bind_files(nb::module_& module) {
  module.def("read", read);
  module.def("write", write);
  module.def("clean", clean_arrays);
  module.def("sample", sample);
}

}  // namespace nonobtuse::python
