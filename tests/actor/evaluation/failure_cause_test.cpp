// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/failure_cause.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

using Point = std::array<float, 3>;
using Cause = FailureCause;

// An object on a table of height 0.4, its goal 10 cm away along x unless a test says otherwise.
class FailureCauseTest : public testing::Test {
 protected:
  static ObservationSpec Spec(bool object) {
    ObservationSpec spec;
    if (object) spec.blocks = {{"object", 3}, {"object_angle", 3}};
    spec.blocks.push_back({"achieved_goal", 3, false});
    spec.blocks.push_back({"desired_goal", 3, false});
    return spec;
  }

  // The cause of an episode in which the object is at these places, one after the other.
  Cause Of(const std::vector<Point>& places, float tilt = 0) {
    FailureFacts facts(Spec(/*object=*/true), tasks::FindTask("FetchPush"));
    for (size_t i = 0; i < places.size(); ++i) {
      const Point& p = places[i];
      const std::vector<float> vector{p[0], p[1], p[2], i > 0 ? tilt : 0, 0,        0,
                                      p[0], p[1], p[2], goal_[0],         goal_[1], goal_[2]};
      i == 0 ? facts.Begin(vector) : facts.Step(vector);
    }
    return facts.Cause();
  }

  const Point start_{1.3F, 0.7F, 0.4F};
  Point goal_{1.4F, 0.7F, 0.4F};
};

TEST_F(FailureCauseTest, EachCauseHasItsEpisode) {
  EXPECT_EQ(Of({start_, {1.5F, 0.7F, 0.4F}, {1.6F, 0.7F, 0.2F}}), Cause::kLeftTheTable);
  EXPECT_EQ(Of({start_, {1.305F, 0.7F, 0.4F}, start_}), Cause::kNeverTouched);
  EXPECT_EQ(Of({start_, {1.33F, 0.7F, 0.4F}}, /*tilt=*/0.6F), Cause::kTipped);
  EXPECT_EQ(Of({start_, {1.4F, 0.7F, 0.4F}, {1.46F, 0.7F, 0.4F}}), Cause::kPassedTheGoal);
  EXPECT_EQ(Of({start_, {1.39F, 0.7F, 0.4F}, {1.34F, 0.7F, 0.4F}}), Cause::kReachedThenLeft);
  EXPECT_EQ(Of({start_, {1.25F, 0.7F, 0.4F}}), Cause::kMovedAway);
  EXPECT_EQ(Of({start_, {1.38F, 0.76F, 0.4F}}), Cause::kBesideTheGoal);
  EXPECT_EQ(Of({start_, {1.34F, 0.7F, 0.4F}}), Cause::kStoppedShort);
}

TEST_F(FailureCauseTest, AGoalInTheAirIsMissedByNotLiftingOrByDropping) {
  goal_ = {1.3F, 0.7F, 0.6F};
  EXPECT_EQ(Of({start_, {1.34F, 0.7F, 0.42F}, {1.34F, 0.7F, 0.4F}}), Cause::kNotLifted);
  EXPECT_EQ(Of({start_, {1.3F, 0.7F, 0.5F}, {1.32F, 0.7F, 0.4F}}), Cause::kDropped);
  EXPECT_EQ(Of({start_, {1.3F, 0.7F, 0.5F}}), Cause::kStoppedShort) << "still held";
}

TEST_F(FailureCauseTest, TheFactsOfAnEpisodeAreItsOwn) {
  FailureFacts facts(Spec(true), tasks::FindTask("FetchPush"));
  const auto vector = [](float x, float z) {
    return std::vector<float>{x, 0.7F, z, 0, 0, 0, x, 0.7F, z, 1.4F, 0.7F, 0.4F};
  };
  facts.Begin(vector(1.3F, 0.4F));
  facts.Step(vector(1.6F, 0.1F));
  EXPECT_EQ(facts.Cause(), Cause::kLeftTheTable);
  facts.Begin(vector(1.3F, 0.4F));
  facts.Step(vector(1.3F, 0.4F));
  EXPECT_EQ(facts.Cause(), Cause::kNeverTouched);
}

TEST_F(FailureCauseTest, WithoutAnObjectDistancesDecide) {
  FailureFacts facts(Spec(/*object=*/false), tasks::FindTask("FetchReach"));
  ASSERT_TRUE(facts.applies());
  EXPECT_EQ(facts.causes().size(), 4u);
  const auto cause = [&](const std::vector<float>& xs) {
    for (size_t i = 0; i < xs.size(); ++i) {
      const std::vector<float> vector{xs[i], 0, 0, 1, 0, 0};
      i == 0 ? facts.Begin(vector) : facts.Step(vector);
    }
    return facts.Cause();
  };
  EXPECT_EQ(cause({0.8F, 0.97F, 0.9F}), Cause::kReachedThenLeft);
  EXPECT_EQ(cause({0.8F, 0.7F}), Cause::kMovedAway);
  EXPECT_EQ(cause({0.8F, 0.9F}), Cause::kStoppedShort);
}

TEST_F(FailureCauseTest, ATaskWithoutGoalsHasNone) {
  EXPECT_FALSE(FailureFacts(Spec(false), tasks::FindTask("Hopper-v4")).applies());
}

}  // namespace
}  // namespace shoal::actor
