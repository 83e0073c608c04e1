#include "launch/run/best_evaluation.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::launch {
namespace {

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
  EXPECT_FALSE(best.best().has_value());
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
