// SPDX-License-Identifier: Apache-2.0
#include "launch/run/flat_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace shoal::launch {
namespace {

using testing::HasSubstr;

// Warnings over `evaluations` with figures by their number.
std::vector<std::string> Warnings(int evaluations,
                                  const std::function<std::optional<double>(int)>& success,
                                  const std::function<double(int)>& mean_return) {
  FlatScore flat;
  std::vector<std::string> warnings;
  for (int i = 0; i < evaluations; ++i) {
    const EvaluationPoint point{.env_steps = static_cast<uint64_t>(1000 * (i + 1)),
                                .success = success(i),
                                .mean_return = mean_return(i)};
    if (const auto line = flat.OnEvaluation(point, 0.98)) warnings.push_back(*line);
  }
  return warnings;
}

double Noise(int i) { return i % 3 == 0 ? 1.0 : i % 3 == 1 ? -0.7 : 0.2; }

TEST(FlatScore, IsSaidOnceWithTheFiguresWhenNothingMoves) {
  const auto warnings = Warnings(
      40, [](int) { return 0.0; }, [](int) { return -50.0; });
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("1000 to 10000 env steps"));
  EXPECT_THAT(warnings[0], HasSubstr("return -50.000 in the first half, -50.000 in the second"));
  EXPECT_THAT(warnings[0], HasSubstr("success 0.0 % and 0.0 %"));
}

TEST(FlatScore, NoiseIsNoProgress) {
  EXPECT_EQ(Warnings(
                10, [](int) { return std::nullopt; }, Noise)
                .size(),
            1u);
}

TEST(FlatScore, NeitherFigureMayRise) {
  const auto rising = [](int i) { return i + Noise(i); };
  EXPECT_TRUE(Warnings(
                  40, [](int) { return 0.0; }, rising)
                  .empty())
      << "the return does";
  EXPECT_TRUE(Warnings(
                  40, [](int i) { return 0.02 * i; }, [](int) { return -50.0; })
                  .empty())
      << "the success does";
}

TEST(FlatScore, ARunAtItsTargetHasNothingToGain) {
  EXPECT_TRUE(Warnings(
                  40, [](int) { return 1.0; }, [](int) { return -1.0; })
                  .empty());
}

TEST(FlatScore, AFallIsNoProgress) {
  const auto warnings = Warnings(
      10, [](int) { return std::nullopt; }, [](int i) { return -i; });
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("success"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace shoal::launch
