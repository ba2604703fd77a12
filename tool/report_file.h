// --report: everything about a call in one file, a page to look at (.html) or its data (.json).
#pragma once

#include <string>

#include "json_report.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::tool {

/// The object "mesh" of the report, docs/json.md: coordinates as floats relative to `origin`.
/// `distance` (#V, to the other surface) may be empty.
Json packed_mesh(const TriangleMesh& mesh, const Vec3& origin, const std::vector<double>& distance);

/// Middle of the bounding box.
Vec3 middle_of(const TriangleMesh& mesh);

/// Writes the report to `path`, whole or not at all: the JSON itself, or, if the name ends in
/// .html, one page that holds it and needs no network. Throws OutputError.
void write_report(const std::string& path, const Json& report);

/// Whether `path` ends in .html, else in .json.
bool is_html(const std::string& path);
bool is_json(const std::string& path);

}  // namespace nonobtuse::tool
