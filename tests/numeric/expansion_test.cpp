#include "numeric/expansion.h"

#include <gtest/gtest.h>

using nonobtuse::numeric::Expansion;

TEST(Expansion, CancellationIsExact) {
  const Expansion big(1e20);
  const Expansion tiny(1e-20);
  EXPECT_EQ((big + tiny - big).sign(), 1);
  EXPECT_EQ((big + tiny - big - tiny).sign(), 0);
  const Expansion third = Expansion::product(1.0 / 3, 3.0) - Expansion(1.0);
  EXPECT_EQ(third.sign(), -1);  // 1/3 rounds down
}
