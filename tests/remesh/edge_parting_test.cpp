// Edges of a cut mesh that gluing would make one.
#include "remesh/edge_parting.h"

#include <gtest/gtest.h>

namespace nonobtuse::pipeline {
namespace {

// A square of the knots 0 to 3, cut along 0-2, and beside it a triangle of the knots a, b and 4.
mesh::EditableMesh square_and_triangle(Index a, Index b) {
  mesh::EditableMesh mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}});
  mesh.knot = {0, 1, 2, 3, a, b, 4};
  return mesh;
}

TEST(EdgeParting, FlipsAnEdgeThatAnotherPatchHasToo) {
  mesh::EditableMesh mesh = square_and_triangle(0, 2);
  EXPECT_EQ(part_edges(true, mesh), 0);
  EXPECT_FALSE(mesh.find_edge(0, 2).valid());
  EXPECT_TRUE(mesh.find_edge(1, 3).valid());
}

TEST(EdgeParting, LeavesEdgesThatAreAlone) {
  mesh::EditableMesh mesh = square_and_triangle(1, 3);
  EXPECT_EQ(part_edges(true, mesh), 0);
  EXPECT_TRUE(mesh.find_edge(0, 2).valid());
}

TEST(EdgeParting, CountsPlacesWhereFlipsDoNotHelp) {
  // The other diagonal is taken as well.
  mesh::EditableMesh mesh({{0, 0, 0},
                           {1, 0, 0},
                           {1, 1, 0},
                           {0, 1, 0},
                           {0, 0, 1},
                           {1, 1, 1},
                           {0, 1, 1},
                           {1, 0, 1},
                           {0, 1, 2},
                           {0, 0, 2}},
                          {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  mesh.knot = {0, 1, 2, 3, 0, 2, 4, 1, 3, 5};
  EXPECT_EQ(part_edges(true, mesh), 1);
}

}  // namespace
}  // namespace nonobtuse::pipeline
