// Random sequences of edits keep the mesh a manifold of the same topology.
#include "mesh/editable_mesh.h"

#include <gtest/gtest.h>

#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;
using mesh::Edge;
using mesh::EditableMesh;

std::vector<Triangle> alive(const EditableMesh& m) {
  std::vector<Triangle> result;
  for (Index t = 0; t < m.triangle_capacity(); ++t)
    if (m.alive_triangle(t)) result.push_back(m.triangle(t));
  return result;
}

Edge random_edge(const EditableMesh& m, numeric::Random& random) {
  for (;;) {
    const Index t = static_cast<Index>(random.below(m.triangle_capacity()));
    if (m.alive_triangle(t)) return {t, static_cast<int>(random.below(3))};
  }
}

std::vector<std::pair<const char*, TriangleMesh>> all_shapes() {
  return {{"sphere", shapes::sphere(1)}, {"torus", shapes::torus(7, 5)},
          {"square", shapes::square(4)}, {"cylinder", shapes::cylinder(3, 5)},
          {"box", shapes::box(2, 2, 1)}, {"octahedron", shapes::sphere(0)}};
}

TEST(EditableMesh, RandomEditsKeepInvariantsAndTopology) {
  for (const auto& [name, input] : all_shapes()) {
    EditableMesh m(input.vertices, input.triangles);
    m.check_invariants();
    const shapes::Topology before = shapes::topology(input.triangles);
    numeric::Random random(7);
    int flips = 0;
    int collapses = 0;
    for (int step = 0; step < 3000; ++step) {
      const Edge e = random_edge(m, random);
      const bool small = m.vertex_count() < 40;
      switch (random.below(small ? 4 : 3)) {
        case 0:
          if (m.can_flip(e)) m.flip(e), ++flips;
          break;
        case 1:
        case 2: {
          const Index removed = random.below(2) ? m.tail(e) : m.head(e);
          if (m.can_collapse(e, removed)) {
            m.collapse(e, removed);
            ASSERT_FALSE(m.alive_vertex(removed));
            ++collapses;
          }
          break;
        }
        default:
          if (random.below(2)) {
            m.split_edge(e, {});
          } else {
            m.split_triangle(e.triangle, {});
          }
      }
      if (step % 50 == 0) {
        ASSERT_NO_THROW(m.check_invariants()) << name << " step " << step;
        shapes::Topology now = shapes::topology(alive(m));
        EXPECT_EQ(now.vertices, m.vertex_count());
        now.vertices = before.vertices;
        ASSERT_EQ(now, before) << name << " step " << step;
      }
    }
    EXPECT_GT(flips, 50) << name;
    EXPECT_GT(collapses, 50) << name;
    const TriangleMesh compacted = m.to_mesh();
    EXPECT_EQ(compacted.vertices.size(), m.vertex_count());
    EXPECT_EQ(compacted.triangles.size(), m.triangle_count());
    EXPECT_EQ(shapes::topology(compacted.triangles).euler, before.euler);
  }
}

// The link condition, decided by building the contracted complex and looking at it.
TEST(EditableMesh, CollapseIsRefusedExactlyWhenTheResultChangesTheTopology) {
  for (const auto& [name, input] : all_shapes()) {
    EditableMesh m(input.vertices, input.triangles);
    const shapes::Topology before = shapes::topology(input.triangles);
    numeric::Random random(3);
    int refused = 0;
    for (int step = 0; step < 400; ++step) {
      const Edge e = random_edge(m, random);
      const Index removed = m.tail(e);
      const Index kept = m.head(e);
      std::vector<Triangle> contracted;
      for (Triangle t : alive(m)) {
        for (Index& v : t) v = v == removed ? kept : v;
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) contracted.push_back(t);
      }
      // Two triangles on the same corners (what a tetrahedron would become) are not a mesh.
      std::set<Triangle> distinct;
      for (Triangle t : contracted) {
        std::sort(t.begin(), t.end());
        distinct.insert(t);
      }
      shapes::Topology after = shapes::topology(contracted);
      after.vertices = before.vertices;
      // A boundary vertex may not leave its loop, though the topology would bear it.
      const bool leaves = m.on_boundary(removed) && m.twin(e).valid();
      const bool expected = after == before && !leaves && distinct.size() == contracted.size();
      ASSERT_EQ(m.can_collapse(e, removed), expected) << name << " step " << step;
      if (!expected) ++refused;
      if (expected && step % 3 == 0) m.collapse(e, removed);
      const Edge other = random_edge(m, random);
      if (m.can_flip(other)) m.flip(other);
      if (m.vertex_count() < 8 && step % 7 == 0) m.split_edge(random_edge(m, random), {});
    }
    EXPECT_GT(refused, 0) << name;
  }
}

TEST(EditableMesh, FlippingTwiceRestoresTheTriangles) {
  const TriangleMesh input = shapes::torus(6, 5);
  EditableMesh m(input.vertices, input.triangles);
  const auto canonical = [](std::vector<Triangle> all) {
    for (Triangle& t : all) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<Triangle> before = canonical(alive(m));
  for (Index t = 0; t < m.triangle_capacity(); ++t) {
    const Edge e{t, 1};
    if (!m.can_flip(e)) continue;
    const Edge diagonal = m.flip(e);
    EXPECT_NE(canonical(alive(m)), before);
    EXPECT_EQ(diagonal.triangle, t);
    ASSERT_TRUE(m.can_flip(diagonal));
    m.flip(diagonal);
    ASSERT_EQ(canonical(alive(m)), before);
  }
}

TEST(EditableMesh, ATetrahedronAndATriangleStay) {
  EditableMesh tetrahedron({{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  EditableMesh triangle({{}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (EditableMesh* m : {&tetrahedron, &triangle})
    for (Index t = 0; t < m->triangle_capacity(); ++t)
      for (int k = 0; k < 3; ++k) {
        EXPECT_FALSE(m->can_collapse({t, k}, m->tail({t, k})));
        EXPECT_FALSE(m->can_flip({t, k}));
      }
}

TEST(EditableMesh, RingsRunCounterClockwise) {
  const TriangleMesh input = shapes::square(4);
  const EditableMesh m(input.vertices, input.triangles);
  std::vector<Index> ring;
  std::vector<Index> fan;
  for (Index v = 0; v < m.vertex_capacity(); ++v) {
    m.neighbors(v, ring);
    m.triangles_around(v, fan);
    ASSERT_EQ(ring.size(), fan.size() + (m.on_boundary(v) ? 1 : 0));
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const int k = m.corner_of(fan[i], v);
      EXPECT_EQ(m.triangle(fan[i])[mesh::next(k)], ring[i]);
      EXPECT_EQ(m.triangle(fan[i])[mesh::previous(k)], ring[(i + 1) % ring.size()]);
      const Edge e = m.find_edge(v, ring[i]);
      ASSERT_TRUE(e.valid());
      EXPECT_EQ(m.tail(e), v);
      EXPECT_EQ(m.head(e), ring[i]);
    }
  }
}

}  // namespace
