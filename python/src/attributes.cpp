// Attributes as a tuple of arrays: (colors, texture_coordinates, texture_faces, labels, names,
// labels_are_groups, material_library), empty arrays for what is missing.
#include "nonobtuse/attributes.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>

#include "bindings.h"

namespace nonobtuse::python {
namespace {

using ColorArray = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using PairArray = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using IndexArray = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

nb::object borders(const VertexArray& vertices, const FaceArray& faces, const nb::tuple& given) {
  return array_of<Index>(attribute_borders(mesh_of(vertices, faces), attributes_of(given)), 2);
}

}  // namespace

MeshAttributes attributes_of(const nb::tuple& given) {
  MeshAttributes a;
  a.colors = rows_of<Color>(nb::cast<ColorArray>(given[0]));
  a.texture_coordinates = rows_of<TextureCoordinate>(nb::cast<PairArray>(given[1]));
  a.texture_triangles = rows_of<Triangle>(nb::cast<FaceArray>(given[2]));
  a.labels = rows_of<Index>(nb::cast<IndexArray>(given[3]));
  a.label_names = nb::cast<std::vector<std::string>>(given[4]);
  a.labels_are_groups = nb::cast<bool>(given[5]);
  a.material_library = nb::cast<std::string>(given[6]);
  return a;
}

nb::tuple to_tuple(MeshAttributes&& a) {
  // Names of a file may be any bytes.
  const auto text = [](const std::string& s) {
    return nb::steal(PyUnicode_DecodeUTF8(s.data(), static_cast<Py_ssize_t>(s.size()), "replace"));
  };
  nb::list names;
  for (const std::string& name : a.label_names) names.append(text(name));
  return nb::make_tuple(array_of<double>(std::move(a.colors), 4),
                        array_of<double>(std::move(a.texture_coordinates), 2),
                        array_of(std::move(a.texture_triangles)), array_of(std::move(a.labels)),
                        names, a.labels_are_groups, text(a.material_library));
}

void bind_attributes(nb::module_& module) { module.def("attribute_borders", borders); }

}  // namespace nonobtuse::python
