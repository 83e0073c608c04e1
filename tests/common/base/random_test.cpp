// SPDX-License-Identifier: Apache-2.0
#include "common/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shoal {
namespace {

TEST(Random, EqualKeysGiveEqualStreamsAndOthersDoNot) {
  Random a(StreamKey(1, StreamRole::kTrainEnvironment, 2, 3));
  Random b(StreamKey(1, StreamRole::kTrainEnvironment, 2, 3));
  Random c(StreamKey(1, StreamRole::kTrainEnvironment, 3, 2));
  Random d(StreamKey(1, StreamRole::kEvalEnvironment, 2, 3));
  const uint64_t first = a.Next();
  EXPECT_EQ(first, b.Next());
  EXPECT_NE(first, c.Next());
  EXPECT_NE(first, d.Next());
}

TEST(Random, StateRestoresTheStream) {
  Random a(7);
  a.Next();
  const Random::State state = a.state();
  const uint64_t next = a.Next();
  Random b(0);
  b.set_state(state);
  EXPECT_EQ(b.Next(), next);
}

TEST(Random, SkippingANormalLeavesTheStreamWhereDrawingItDoes) {
  Random drawn(7), skipped(7);
  drawn.Normal();
  skipped.SkipNormal();
  EXPECT_EQ(skipped.state(), drawn.state());
}

// Streams are part of the files' meaning: a change would silently change every seed.
TEST(Random, StreamsAreStable) {
  EXPECT_EQ(HashWords({1, 2, 3}), 11729535726472988794ULL);
  EXPECT_EQ(HashBytes("shoal", 5), 1739162015010441140ULL);
  EXPECT_EQ(Random(1).Next(), 14971601782005023387ULL);
}

// 5-sigma bounds computed from the distribution: sigma of a count is sqrt(n p (1-p)).
bool LooksUniform(const std::vector<int>& counts, int draws) {
  const double p = 1.0 / static_cast<double>(counts.size());
  const double bound = 5 * std::sqrt(draws * p * (1 - p));
  for (int count : counts) {
    if (std::abs(count - draws * p) > bound) return false;
  }
  return true;
}

TEST(Random, BelowIsUniformAndABiasedDrawWouldBeSeen) {
  Random random(3);
  constexpr int kDraws = 100'000;
  std::vector<int> fair(7), biased(7);
  for (int i = 0; i < kDraws; ++i) {
    ++fair[random.Below(7)];
    ++biased[random.Below(70) == 0 ? 0 : random.Below(7)];
  }
  EXPECT_TRUE(LooksUniform(fair, kDraws));
  EXPECT_FALSE(LooksUniform(biased, kDraws));
}

TEST(Random, NormalHasUnitMoments) {
  Random random(4);
  constexpr int kDraws = 200'000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 5 / std::sqrt(double{kDraws}));
  EXPECT_NEAR(squares / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
}

TEST(Random, UniformStaysInsideItsInterval) {
  Random random(5);
  for (int i = 0; i < 10'000; ++i) {
    const double x = random.Uniform(-2, 3);
    EXPECT_GE(x, -2);
    EXPECT_LT(x, 3);
  }
}

}  // namespace
}  // namespace shoal
