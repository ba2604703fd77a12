// Solutions in a plane satisfy the projected equations.
#include "numeric/symmetric_matrix.h"

#include <gtest/gtest.h>

#include "numeric/random.h"

namespace nonobtuse::numeric {
namespace {

Vec3 random_vector(Random& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

TEST(SymmetricMatrix, OuterProductsActAsTheyShould) {
  Random random(1);
  const Vec3 v = random_vector(random);
  const Vec3 x = random_vector(random);
  SymmetricMatrix m;
  m.add_identity(2);
  m.add_outer(3, v);
  EXPECT_LT(distance(m * x, 2 * x + 3 * dot(v, x) * v), 1e-15);
}

TEST(SymmetricMatrix, TangentialSolutions) {
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    Vec3 n = normalized(random_vector(random));
    if (k == 0) n = {0, 0, -1};
    SymmetricMatrix m;
    m.add_identity(0.1);
    for (int j = 0; j < 3; ++j) m.add_outer(1, random_vector(random));
    const Vec3 v = random_vector(random);
    const Vec3 x = solve_tangential(m, n, v);
    EXPECT_NEAR(dot(x, n), 0, 1e-12);
    const Vec3 residual = m * x - v;
    EXPECT_LT(length(residual - dot(residual, n) * n), 1e-12);
  }
  EXPECT_EQ(solve_tangential({}, {0, 0, 1}, {1, 0, 0}), Vec3{});
}

}  // namespace
}  // namespace nonobtuse::numeric
