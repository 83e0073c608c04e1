// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/random_baseline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

using nlohmann::ordered_json;

bool Never() { return false; }

TEST(RandomBaseline, FetchReachDenseEarnsWhatRandomActionsEarn) {
  constexpr int kEpisodes = 20;
  const ordered_json result = PlayRandom({.task = "FetchReachDense", .episodes = kEpisodes}, Never);
  const ordered_json& all = result.at("aggregate");
  EXPECT_EQ(result.at("schema"), "shoal-eval-1");
  EXPECT_EQ(result.at("policy"), "random");
  EXPECT_EQ(result.at("deterministic"), false);
  EXPECT_TRUE(result.at("checkpoint").is_null());
  EXPECT_TRUE(result.at("weights_version").is_null());
  EXPECT_EQ(result.at("episodes").size(), size_t{kEpisodes});
  EXPECT_NEAR(all.at("length_mean").get<double>(), 50, 1e-9);
  // -9.79 is the mean of 2000 other episodes; five standard errors of this mean around it.
  const double error = all.at("return_std").get<double>() / std::sqrt(kEpisodes);
  EXPECT_NEAR(all.at("return_mean").get<double>(), -9.79, 5 * error);
  EXPECT_GT(error, 0.1) << "episodes are not all the same";
  EXPECT_LE(all.at("success_rate").get<double>(), 0.1);
}

TEST(RandomBaseline, SuccessGrowsWithTheThresholdAndAgreesAtTheTasksOwn) {
  const ordered_json result = PlayRandom({.task = "FetchReachDense", .episodes = 20}, Never);
  double before = 0;
  bool own = false;
  for (const ordered_json& point : result.at("success_by_threshold")) {
    EXPECT_GE(point.at("success_rate"), before);
    before = point.at("success_rate");
    if (point.at("threshold") != 0.05) continue;
    own = true;
    EXPECT_EQ(point.at("success_rate"), result.at("aggregate").at("success_rate"));
  }
  EXPECT_TRUE(own);
  EXPECT_GT(before, 0.8) << "half a metre is reached by nearly every episode";
}

TEST(RandomBaseline, EqualSeedsGiveEqualEpisodes) {
  const auto episodes = [](int64_t seed) {
    return PlayRandom({.task = "FetchReachDense", .episodes = 3, .seed = seed}, Never)
        .at("episodes");
  };
  EXPECT_EQ(episodes(1), episodes(1));
  EXPECT_NE(episodes(1), episodes(2));
}

TEST(RandomBaseline, EveryTaskHasOneAndThoseWithoutGoalsHaveNoCurve) {
  for (const std::string& name : tasks::TaskNames()) {
    const ordered_json result = PlayRandom({.task = name, .episodes = 1}, Never);
    EXPECT_TRUE(std::isfinite(result.at("aggregate").at("return_mean").get<double>())) << name;
    EXPECT_EQ(result.at("success_by_threshold").is_null(), tasks::FindTask(name).goal_size() == 0);
    EXPECT_THAT(RandomText(result), testing::HasSubstr(name));
  }
}

// Without actions the arm settles by millimetres only, so the distance hardly changes: the return
// of FetchReachDense is nearly that of 50 equal steps. The episodes are the same as for random
// actions.
TEST(RandomBaseline, NoopActsWithZeros) {
  const ordered_json noop =
      PlayRandom({.task = "FetchReachDense", .episodes = 5, .policy = "noop"}, Never);
  EXPECT_EQ(noop.at("policy"), "noop");
  EXPECT_EQ(noop.at("deterministic"), true);
  EXPECT_TRUE(noop.at("checkpoint").is_null());
  for (const ordered_json& episode : noop.at("episodes")) {
    EXPECT_EQ(episode.at("action_smoothness"), 0.0);
    EXPECT_NEAR(episode.at("return").get<double>(),
                -50 * episode.at("final_distance").get<double>(), 50 * 0.005);
  }
  EXPECT_THAT(RandomText(noop), testing::HasSubstr("5 noop episodes"));
  EXPECT_THROW(PlayRandom({.task = "FetchReachDense", .policy = "best"}, Never), Error);
}

TEST(RandomBaseline, AThresholdOfOnesOwnJudgesTheEpisodes) {
  const ordered_json wide = PlayRandom(
      {.task = "FetchReach", .episodes = 5, .policy = "noop", .distance_threshold = 10}, Never);
  EXPECT_EQ(wide.at("aggregate").at("success_rate"), 1.0);
}

TEST(RandomBaseline, EpisodesEndOnSuccessWhereTheyDoInTraining) {
  const ordered_json result = PlayRandom(
      {.task = "FetchReach", .episodes = 5, .distance_threshold = 10, .end_on_success = true},
      Never);
  EXPECT_EQ(result.at("aggregate").at("length_mean"), 1.0);
  EXPECT_EQ(result.at("aggregate").at("success_rate"), 1.0);
  EXPECT_EQ(result.at("end_on_success"), true);
  EXPECT_FALSE(PlayRandom({.task = "FetchReach", .episodes = 1}, Never).contains("end_on_success"));
}

TEST(RandomBaseline, AStopOrAnUnknownTaskIsAnError) {
  EXPECT_THROW(PlayRandom({.task = "FetchReach"}, [] { return true; }), Error);
  try {
    PlayRandom({.task = "FetchSleep"}, Never);
    FAIL() << "played a task that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("FetchReachDense"));
  }
}

}  // namespace
}  // namespace shoal::actor
