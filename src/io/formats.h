// The four formats: a reader from memory and a writer to memory each.
#pragma once

#include <string>

#include "io/scanner.h"
#include "nonobtuse/io.h"

namespace nonobtuse::io {

/// Wavefront OBJ: `v`, `vt`, `f`, `usemtl`, `g` and `mtllib` count, all else is skipped.
ReadResult read_obj(const Source& source);
std::string write_obj(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// Geomview OFF with its prefixes (COFF, NOFF, STOFF); colours and normals are skipped.
ReadResult read_off(const Source& source);
std::string write_off(const TriangleMesh& mesh);

/// Stanford PLY, ascii or binary of both byte orders; elements and properties that are not needed
/// are skipped.
ReadResult read_ply(const Source& source);
std::string write_ply(const TriangleMesh& mesh, const MeshAttributes& attributes, bool binary);

/// STL: corners with exactly equal coordinates become one vertex, in order of first appearance.
ReadResult read_stl(const Source& source);
std::string write_stl(const TriangleMesh& mesh, bool binary);
/// Whether the bytes are a complete binary STL: 84 + 50 times the number of facets they claim.
bool is_binary_stl(std::string_view bytes);

}  // namespace nonobtuse::io
