// Part of nonobtuse, MIT licence. Mesh files in and out, and the cleaning of what they hold.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nonobtuse/attributes.h"
#include "nonobtuse/error.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse {

enum class FileFormat { Obj, Off, Ply, Stl };

/// One kind of repair that was made, for the user to see.
struct Repair {
  std::string what;  ///< plural noun phrase: "polygons triangulated", "duplicate vertices welded"
  Index count = 0;
  Index first = -1;  ///< index (from 0) of the first element concerned, in the file's order
};

struct ReadResult {
  TriangleMesh mesh;
  MeshAttributes attributes;  ///< OBJ, PLY: those that the file holds for every vertex or face
  FileFormat format = FileFormat::Obj;
  std::vector<Repair> repairs;  ///< made while reading (polygons triangulated, STL corners welded)
};

/// Reads OBJ, OFF, PLY (ascii, binary of both byte orders) or STL (ascii, binary), told by content.
/// Coordinates are doubles throughout. Only what the format itself demands is done: polygons are
/// triangulated and the corners of an STL welded where they are equal; call `clean` for the rest.
/// Attributes: OBJ `v x y z r g b`, `vt` and `usemtl` (without any, `g`) as labels with names; PLY
/// vertex properties red, green, blue, alpha (integers are divided by their largest value) and s, t
/// or u, v, face lists `texcoord`, and a face property label, segment, group or material_index.
/// Throws IoError (file, line, what is wrong) and InvalidInput (indices out of range, coordinates
/// that are not finite).
ReadResult read_mesh(const std::string& path);

/// The same from the bytes of a file; `name` (with a suffix, if known) stands in messages.
ReadResult read_mesh_from_memory(std::string_view bytes, const std::string& name = "mesh");

struct WriteOptions {
  bool binary = true;  ///< PLY and STL only; PLY is written in doubles
};

/// Writes by suffix (.obj .off .ply .stl), texts in the shortest form that reads back the same
/// doubles. Writes to a temporary name beside `path` and renames: never half a file.
/// Throws IoError, and InvalidInput for indices out of range and coordinates that are not finite or
/// beyond the range of a float in a binary STL.
void write_mesh(const std::string& path, const TriangleMesh& mesh,
                const WriteOptions& options = {});

/// The same with attributes, in OBJ and PLY; OFF and STL leave them out. OBJ keeps doubles; PLY
/// holds colours in 8 bits and texture coordinates in floats, as its readers expect, and no names.
/// Throws InvalidInput also for attributes that do not belong to the mesh.
void write_mesh(const std::string& path, const TriangleMesh& mesh, const MeshAttributes& attributes,
                const WriteOptions& options = {});
std::string write_mesh_to_memory(FileFormat format, const TriangleMesh& mesh,
                                 const MeshAttributes& attributes,
                                 const WriteOptions& options = {});

/// The bytes that `write_mesh` writes.
std::string write_mesh_to_memory(FileFormat format, const TriangleMesh& mesh,
                                 const WriteOptions& options = {});

/// The coordinates as a reader of the written file sees them (binary STL holds floats).
TriangleMesh as_written(const std::string& path, const TriangleMesh& mesh,
                        const WriteOptions& options = {});

/// Replaces any file by `bytes`, whole or not at all, as `write_mesh` does. Throws IoError.
void write_file(const std::string& path, std::string_view bytes);

struct CleanResult {
  TriangleMesh mesh;
  std::vector<Repair> repairs;
  /// What is unusual, but needs no repair: edges of three or more faces, vertices where several
  /// fans of faces touch. Remeshing keeps them.
  std::vector<Repair> kept;
  /// Number in the input of every triangle; of one that took the place of others (where some
  /// without area went), that of a triangle which it shares an edge with.
  std::vector<Index> source_triangle;
  std::vector<Index> source_vertex;  ///< number in the input of every vertex
  MeshAttributes attributes;         ///< of the cleaned mesh, where there were any
};

/// Makes a mesh fit for `remesh`: drops degenerate faces (repeated vertex or exactly no area) and
/// unused vertices, turns faces that disagree with their neighbours. Reports each repair. Patches
/// that meet along an edge of three or more faces are oriented each by itself.
/// Throws InvalidInput, with the element's index, for what cannot be mended: non-finite
/// coordinates, indices out of range, a surface that cannot be oriented, nothing but degenerate
/// faces.
CleanResult clean(const TriangleMesh& mesh);

/// The same with attributes. Faces that take the place of others (where some without area went)
/// take over those of a face that they share an edge with.
/// Throws InvalidInput also for attributes that do not belong to the mesh.
CleanResult clean(const TriangleMesh& mesh, const MeshAttributes& attributes);

}  // namespace nonobtuse
