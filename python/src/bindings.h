// The parts of the extension module, one function and one file each, and what they share.
#pragma once

#include "arrays.h"
#include "nonobtuse/certificate.h"
#include "nonobtuse/io.h"
#include "nonobtuse/quality.h"

namespace nonobtuse::python {

void bind_attributes(nb::module_& module);
void bind_files(nb::module_& module);
void bind_quality(nb::module_& module);
void bind_remesh(nb::module_& module);
void bind_stages(nb::module_& module);

/// The objects "angles" and "repairs" of docs/json.md.
nb::dict angles_dict(const AngleQuality& angles);
nb::list to_list(const std::vector<Repair>& repairs);
/// (min_angle, max_angle, certified, triangles, too_large, too_small), the lists as arrays.
nb::tuple to_tuple(Certificate&& certificate);
/// Attributes of a mesh and back: see attributes.cpp.
MeshAttributes attributes_of(const nb::tuple& given);
nb::tuple to_tuple(MeshAttributes&& attributes);
/// The repairs, and what is unusual but kept.
std::vector<Repair> noted(const CleanResult& cleaned);

/// (vertices, faces, repairs)
nb::tuple to_tuple(TriangleMesh&& mesh, const std::vector<Repair>& repairs);

}  // namespace nonobtuse::python
