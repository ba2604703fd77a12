// Part of nonobtuse, MIT licence. What a mesh carries beside its shape, and how it gets from a
// mesh to its remeshed form.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "nonobtuse/mesh.h"
#include "nonobtuse/result.h"

namespace nonobtuse {

/// Colour of a vertex: red, green, blue, alpha, in [0, 1].
using Color = std::array<double, 4>;
/// Texture coordinates u, v.
using TextureCoordinate = std::array<double, 2>;

/// Attributes of a mesh. Each array is either empty or complete.
struct MeshAttributes {
  std::vector<Color> colors;                           ///< #V
  std::vector<TextureCoordinate> texture_coordinates;  ///< #T by 2
  /// #F by 3: the texture coordinate of every corner, in [0, #T), or -1 where a face has none. A
  /// seam is an edge whose two faces disagree on the texture coordinate of an end.
  std::vector<Triangle> texture_triangles;
  std::vector<Index> labels;             ///< #F, >= 0: material, group or segment of a face
  std::vector<std::string> label_names;  ///< of each label; may be shorter, or hold empty names
  bool labels_are_groups = false;        ///< OBJ: `g` instead of `usemtl`
  std::string material_library;  ///< OBJ: the `mtllib` that explains the names; may be empty

  [[nodiscard]] bool empty() const {
    return colors.empty() && texture_triangles.empty() && labels.empty();
  }
};

/// The edges between faces of different labels and the seams of the texture, each as two vertices
/// in ascending order, sorted. Boundary edges are not among them. As RemeshOptions::feature_edges
/// they stay edges of the result.
/// Throws InvalidInput if an array is neither empty nor complete, or an index is out of range.
std::vector<std::array<Index, 2>> attribute_borders(const TriangleMesh& mesh,
                                                    const MeshAttributes& attributes);

/// The attributes of a remeshed surface. `mesh` with `attributes` is what was remeshed, `result`
/// what came out.
/// - A vertex gets the colour of its nearest point (`source_triangle`, `barycentric`), linearly.
/// - A face gets the label of the input nearest to its centroid.
/// - A corner gets the texture coordinate of its vertex's nearest point on its face's own side of
///   the seams, so that seams stay seams and no face spans one; corners that agree share one.
/// Where borders and seams were features of the call, faces lie on one side of them and labels keep
/// their areas exactly; where they were not, borders are off by up to half a face.
/// Throws InvalidInput as `attribute_borders`, and if `result` has no `source_triangle`.
/// Deterministic; single-threaded.
MeshAttributes transfer_attributes(const TriangleMesh& mesh, const MeshAttributes& attributes,
                                   const RemeshResult& result);

}  // namespace nonobtuse
