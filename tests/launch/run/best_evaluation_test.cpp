// SPDX-License-Identifier: Apache-2.0
#include "launch/run/best_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace shoal::launch {
namespace {

using testing::ElementsAre;

EvaluationPoint Point(std::optional<double> success, double mean_return) {
  return {.success = success, .mean_return = mean_return, .episodes = 50};
}

// Return of the best one.
double BestReturn(const std::vector<EvaluationPoint>& points) {
  BestEvaluation best;
  for (const EvaluationPoint& point : points) best.OnEvaluation(point);
  return best.best()->mean_return;
}

TEST(BestEvaluation, ThereIsNoneAtFirst) {
  const BestEvaluation best;
  EXPECT_EQ(best.best(), nullptr);
  EXPECT_FALSE(best.newest_is_best());
}

TEST(BestEvaluation, GoesByReturnWhereThereIsNoSuccess) {
  EXPECT_EQ(BestReturn({Point({}, 10), Point({}, 300), Point({}, 250)}), 300);
}

TEST(BestEvaluation, MoreSuccessThanChanceExplainsBeatsAnyReturn) {
  EXPECT_EQ(BestReturn({Point(0.5, -1), Point(0.9, -5)}), -5);
  EXPECT_EQ(BestReturn({Point(0.9, -5), Point(0.5, -1)}), -5);
}

TEST(BestEvaluation, WithinChanceTheReturnDecides) {
  EXPECT_EQ(BestReturn({Point(1.0, -1.17), Point(0.98, -0.68)}), -0.68) << "one episode of fifty";
  EXPECT_EQ(BestReturn({Point(1.0, -0.68), Point(0.98, -1.17)}), -0.68);
  EXPECT_EQ(BestReturn({Point(1.0, -1.17), Point(0.96, -0.68)}), -1.17) << "two";
}

TEST(BestEvaluation, IsMeasuredAgainstTheHighestSuccessNotTheFormerBest) {
  EXPECT_EQ(BestReturn({Point(1.0, -1.2), Point(0.98, -1.1), Point(0.96, -1.0)}), -1.1);
}

TEST(BestEvaluation, OneThatIsOutdoneGivesWayToTheOneThatDidIt) {
  EXPECT_EQ(BestReturn({Point(0.9, -0.5), Point(1.0, -1.5)}), -1.5);
}

// The second is within chance of the third and has the better return, although the first was better
// at the time of the second.
TEST(BestEvaluation, DoesNotDependOnTheOrder) {
  std::vector<EvaluationPoint> points{Point(0.96, -0.5), Point(0.98, -0.6), Point(1.0, -0.9),
                                      Point(0.94, -0.55)};
  std::ranges::sort(points, {}, &EvaluationPoint::mean_return);
  do {
    EXPECT_EQ(BestReturn(points), -0.6);
  } while (std::ranges::next_permutation(points, {}, &EvaluationPoint::mean_return).found);
}

TEST(BestEvaluation, CandidatesAreThoseThatMayBecomeTheBest) {
  BestEvaluation best;
  const auto after = [&](const EvaluationPoint& point) {
    best.OnEvaluation(point);
    std::vector<double> returns;
    for (const EvaluationPoint& each : best.candidates()) returns.push_back(each.mean_return);
    return returns;
  };
  EXPECT_THAT(after(Point(0.96, -0.5)), ElementsAre(-0.5));
  EXPECT_THAT(after(Point(0.98, -0.6)), ElementsAre(-0.5, -0.6));
  EXPECT_THAT(after(Point(0.96, -0.55)), ElementsAre(-0.5, -0.6)) << "outdone in both";
  EXPECT_THAT(after(Point(1.0, -0.9)), ElementsAre(-0.6, -0.9)) << "the first is beyond chance now";
  EXPECT_THAT(after(Point(1.0, -0.4)), ElementsAre(-0.4));
}

TEST(BestEvaluation, FewerEpisodesSayLess) {
  EvaluationPoint all = Point(1.0, -1.2), most = Point(0.9, -1.0);
  EXPECT_EQ(BestReturn({all, most}), -1.2);
  all.episodes = most.episodes = 10;
  EXPECT_EQ(BestReturn({all, most}), -1.0);
}

TEST(BestEvaluation, SaysWhetherTheNewestIsIt) {
  BestEvaluation best;
  best.OnEvaluation(Point(0.5, -2));
  EXPECT_TRUE(best.newest_is_best());
  best.OnEvaluation(Point(0.2, -1));
  EXPECT_FALSE(best.newest_is_best());
  best.OnEvaluation(Point(0.5, -2));
  EXPECT_FALSE(best.newest_is_best()) << "the first of equals";
}

}  // namespace
}  // namespace shoal::launch
