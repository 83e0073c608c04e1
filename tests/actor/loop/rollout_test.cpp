// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/rollout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "tests/actor/loop/rollout_parts.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

class RolloutTest : public testing::Test {
 protected:
  void Start(int envs) { parts_.emplace(run_.path(), sink_, envs, kFirstEnv); }
  Rollout& rollout() { return parts_->rollout; }
  void Step(int vector_steps) {
    for (int i = 0; i < vector_steps; ++i) ASSERT_TRUE(rollout().TryStep());
  }
  // The last digits of the environment's key, which its observations contain.
  float KeyDigits(uint32_t env, uint32_t episode) const {
    return static_cast<float>(
        StreamKey(parts_->config.seed, StreamRole::kTrainEnvironment, env, episode) % 1000);
  }

  const TemporaryFolder run_;
  FakeSink sink_{CountingEnvironment().spec()};
  std::optional<RolloutParts> parts_;
};

TEST_F(RolloutTest, AnEpisodeIsAResetAndItsSteps) {
  Start(1);
  Step(CountingEnvironment::kLength + 1);
  ASSERT_EQ(sink_.records.size(), 6u);
  EXPECT_THAT(sink_.sequences, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(parts_->made.made(), 6u);
  EXPECT_EQ(rollout().env_steps(), 4u);
  const std::vector<uint32_t> episodes{0, 0, 0, 0, 1, 1}, indices{0, 1, 2, 3, 0, 1};
  for (size_t i = 0; i < 6; ++i) {
    const uint8_t* record = sink_.Bytes(i);
    const RecordHeader& header = sink_.Header(i);
    EXPECT_EQ(RecordFault(sink_.layout(), record), nullptr) << i;
    EXPECT_EQ(header.sequence, i + 1);
    EXPECT_EQ(header.env, kFirstEnv);
    EXPECT_EQ(header.episode, episodes[i]);
    EXPECT_EQ(header.index, indices[i]);
    EXPECT_EQ(header.kind, indices[i] == 0 ? RecordKind::kReset : RecordKind::kStep);
    EXPECT_EQ(header.distance, static_cast<float>(100 - static_cast<int>(indices[i])));
    EXPECT_EQ(header.weights_session, 0u);
    EXPECT_THAT(sink_.layout().Vector(record),
                ElementsAre(KeyDigits(kFirstEnv, episodes[i]), static_cast<float>(indices[i])));
    EXPECT_THAT(sink_.layout().Frame(record), Each(sink_.layout().Frame(record)[0]));
    EXPECT_EQ(sink_.layout().Frame(record)[0] % 10, indices[i]);
    const auto action = sink_.layout().Action(record);
    EXPECT_EQ(header.reward, indices[i] == 0 ? 0 : action[0]) << "of its own action";
    EXPECT_EQ((header.flags & kSuccess) != 0, action[0] > 0.5F);
    EXPECT_EQ((header.flags & (kTerminated | kTruncated)) != 0, indices[i] == 3);
  }
  EXPECT_NE(sink_.layout().Action(sink_.Bytes(1))[0], sink_.layout().Action(sink_.Bytes(2))[0]);
}

// Alone: its environment, and so its spec, is another.
TEST(GoalPictures, AGoalRecordComesBeforeEachResetAndThePolicySeesItsPicture) {
  const TemporaryFolder run;
  const CountingEnvironment like(CountingEnvironment::kLength, 2, /*goal_picture=*/true);
  const ObservationSpec& spec = like.spec();
  FakeSink sink(spec);
  const Config config = SmallConfig(/*envs=*/1);
  SequenceLog made(run.path(), /*actor=*/0, /*session=*/10, kFirstEnv, /*envs=*/1);
  ActionSelector selector(config, spec, /*envs=*/1);
  std::vector<std::unique_ptr<worlds::Environment>> environments;
  environments.push_back(
      std::make_unique<CountingEnvironment>(CountingEnvironment::kLength, 2, true));
  Rollout rollout(Rollout::Options::Of(config, kFirstEnv), spec, std::move(environments), made,
                  sink, selector);
  sink.room = 2;
  EXPECT_FALSE(rollout.TryStep()) << "a goal, a reset and a step need room";
  sink.room = 3;
  for (int i = 0; i < CountingEnvironment::kLength + 1; ++i) ASSERT_TRUE(rollout.TryStep());
  using K = RecordKind;
  const std::vector<K> kinds{K::kGoal, K::kReset, K::kStep,  K::kStep,
                             K::kStep, K::kGoal,  K::kReset, K::kStep};
  ASSERT_EQ(sink.records.size(), kinds.size());
  EXPECT_THAT(sink.sequences, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  for (size_t i = 0; i < kinds.size(); ++i) {
    EXPECT_EQ(RecordFault(sink.layout(), sink.Bytes(i)), nullptr) << i;
    EXPECT_EQ(sink.Header(i).kind, kinds[i]) << i;
    EXPECT_EQ(sink.Header(i).episode, i < 5 ? 0u : 1u);
    const uint8_t pixel = sink.layout().Frame(sink.Bytes(i))[0];
    EXPECT_EQ(pixel >= 200, kinds[i] == K::kGoal) << i;
  }
  EXPECT_THAT(sink.layout().Vector(sink.Bytes(0)),
              testing::ElementsAreArray(sink.layout().Vector(sink.Bytes(1))))
      << "all but the picture is the reset's";
  const auto input = selector.FrameStackOf(0);
  ASSERT_EQ(input.size(), static_cast<size_t>(spec.InputBytes()));
  EXPECT_THAT(input.last(static_cast<size_t>(spec.FrameBytes())),
              Each(sink.layout().Frame(sink.Bytes(5))[0]));
  EXPECT_THAT(input.first(static_cast<size_t>(2 * spec.FrameBytes())), Each(testing::Lt(200)));
}

TEST_F(RolloutTest, TheFiguresOfEndedEpisodesAreLogged) {
  Start(1);
  Step(2 * CountingEnvironment::kLength);
  ASSERT_EQ(rollout().episodes().count(), 2u);
  double sum = 0;
  for (size_t i = 0; i < sink_.records.size(); ++i) sum += sink_.Header(i).reward;
  EXPECT_NEAR(rollout().episodes().Mean().episode_return, sum / 2, 1e-6);
  EXPECT_EQ(rollout().episodes().Mean().length, CountingEnvironment::kLength);
}

// Environments with episodes of the task's length, 50 steps.
class SpreadResetsTest : public RolloutTest {
 protected:
  static constexpr int kSteps = 50;

  void Start(int envs) {
    parts_.emplace(run_.path(), sink_, SmallConfig(envs), kFirstEnv, /*session=*/10, kSteps);
  }
  // Steps, and returns the environments that were reset in this step.
  std::vector<int> Resets() {
    const size_t before = sink_.records.size();
    Step(1);
    std::vector<int> resets;
    for (size_t i = before; i < sink_.records.size(); ++i) {
      const RecordHeader& header = sink_.Header(i);
      if (header.kind == RecordKind::kReset)
        resets.push_back(static_cast<int>(header.env - kFirstEnv));
    }
    return resets;
  }
  // Lengths of the ended episodes, by environment.
  std::vector<std::vector<int>> Lengths(int envs) const {
    std::vector<std::vector<int>> lengths(static_cast<size_t>(envs));
    for (size_t i = 0; i < sink_.records.size(); ++i) {
      const RecordHeader& header = sink_.Header(i);
      if ((header.flags & (kTerminated | kTruncated)) == 0) continue;
      lengths[header.env - kFirstEnv].push_back(static_cast<int>(header.index));
    }
    return lengths;
  }
};

TEST_F(SpreadResetsTest, FirstEpisodesAreCutSoThatNoTwoResetsFallIntoOneStepAgain) {
  Start(4);
  EXPECT_THAT(Resets(), ElementsAre(0, 1, 2, 3));
  for (int step = 1; step <= 3 * kSteps; ++step) EXPECT_LE(Resets().size(), 1u) << step;
  using L = std::vector<int>;
  EXPECT_THAT(Lengths(4), ElementsAre(L{13, 50, 50}, L{25, 50, 50}, L{38, 50, 50}, L{50, 50, 50}));
}

TEST_F(SpreadResetsTest, ACutEpisodeIsTruncatedAtWhatWasObservedLast) {
  Start(4);
  Step(13);
  const size_t last = sink_.records.size() - 4;
  EXPECT_EQ(sink_.Header(last).env, kFirstEnv);
  EXPECT_EQ(sink_.Header(last).flags & (kTerminated | kTruncated), kTruncated);
  EXPECT_EQ(sink_.layout().Vector(sink_.Bytes(last))[1], 13);
  EXPECT_EQ(sink_.Header(last).distance, 100 - 13);
  for (size_t i = last + 1; i < last + 4; ++i) {
    EXPECT_EQ(sink_.Header(i).flags & (kTerminated | kTruncated), 0) << i;
  }
}

TEST_F(SpreadResetsTest, EveryEpisodeOfALoneEnvironmentIsWhole) {
  Start(1);
  Step(2 * kSteps);
  EXPECT_THAT(Lengths(1), ElementsAre(std::vector<int>{50, 50}));
}

TEST_F(SpreadResetsTest, FiguresLeaveOutEpisodesThatAreCut) {
  Start(4);
  Step(kSteps - 1);
  EXPECT_EQ(rollout().episodes().count(), 0u);
  Step(1);
  EXPECT_EQ(rollout().episodes().count(), 1u) << "the last environment's is whole";
  Step(13);
  EXPECT_EQ(rollout().episodes().count(), 2u);
  EXPECT_EQ(rollout().episodes().Mean().length, kSteps);
}

// If episodes are cut, only those that ended before their cut are complete.
TEST_F(RolloutTest, FiguresLeaveOutEpisodesThatWereToBeCutAndEndedBefore) {
  Start(2);
  Step(CountingEnvironment::kLength);
  EXPECT_EQ(rollout().episodes().count(), 1u);
}

TEST_F(SpreadResetsTest, AreSpreadAnewAfterAllEpisodesWereAbandoned) {
  Start(2);
  Step(kSteps);
  rollout().AbandonEpisodes();
  EXPECT_THAT(Resets(), ElementsAre(0, 1));
  Step(2 * kSteps);
  EXPECT_THAT(Lengths(2), ElementsAre(std::vector<int>{25, 25, 50}, std::vector<int>{50, 50, 50}));
}

TEST_F(SpreadResetsTest, ACutEpisodeGoesOnFromItsState) {
  Start(2);
  Step(20);
  const RolloutState state = rollout().State();
  const TemporaryFolder run;
  FakeSink sink(parts_->spec);
  RolloutParts successor(run.path(), sink, SmallConfig(2), kFirstEnv, /*session=*/10, kSteps);
  successor.rollout.Restore(state);
  EXPECT_EQ(successor.rollout.State(), state);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(successor.rollout.TryStep());
  const RecordHeader& last = sink.Header(sink.records.size() - 2);
  EXPECT_EQ(last.index, 25u);
  EXPECT_EQ(last.flags & kTruncated, kTruncated);
}

TEST_F(RolloutTest, StepsNothingWithoutRoomForAResetAndAStepOfEach) {
  Start(2);
  sink_.room = 3;
  EXPECT_FALSE(rollout().TryStep());
  EXPECT_TRUE(sink_.records.empty());
  EXPECT_EQ(parts_->made.made(), 0u);
  sink_.room = 4;
  EXPECT_TRUE(rollout().TryStep());
  EXPECT_EQ(sink_.records.size(), 4u);
  EXPECT_EQ(rollout().vector_steps(), 1);
  EXPECT_EQ(rollout().env_steps(), 2u);
}

TEST_F(RolloutTest, ARecordNamesTheWeightsThatChoseItsAction) {
  Start(1);
  Step(1);
  parts_->Load({7, 20});
  Step(1);
  EXPECT_EQ(sink_.Header(1).weights_session, 0u);
  EXPECT_EQ(sink_.Header(2).weights_session, 7u);
  EXPECT_EQ(sink_.Header(2).weights_update, 20u);
}

// The exploration of an episode depends only on its name, not on actor or time.
TEST_F(RolloutTest, TheSameEpisodeHasTheSameActionsWhicheverActorPlaysIt) {
  Start(2);
  Step(1);
  const TemporaryFolder other_run;
  FakeSink other_sink(parts_->spec);
  RolloutParts other(other_run.path(), other_sink, /*envs=*/1, /*first_env=*/kFirstEnv + 1);
  ASSERT_TRUE(other.rollout.TryStep());
  // Resets of both environments, then their steps.
  EXPECT_EQ(sink_.layout().Action(sink_.Bytes(3))[0],
            sink_.layout().Action(other_sink.Bytes(1))[0]);
  EXPECT_NE(sink_.layout().Action(sink_.Bytes(3))[0], sink_.layout().Action(sink_.Bytes(2))[0]);
}

TEST_F(RolloutTest, GoesOnBitForBitFromItsState) {
  Start(2);
  parts_->Load({7, 20});
  Step(CountingEnvironment::kLength + 2);
  const RolloutState state = rollout().State();
  const size_t before = sink_.records.size();
  Step(5);

  // The successor's sequence log continues its predecessor's, as the file does after a restart.
  const TemporaryFolder run;
  FakeSink sink(parts_->spec);
  RolloutParts successor(run.path(), sink, /*envs=*/2, kFirstEnv);
  for (size_t i = 0; i < before; ++i) successor.made.CountRecord();
  for (const uint32_t e : {0, 1}) {
    while (successor.made.TakeEpisode(e) < state.episodes[e].episode) {
    }
  }
  successor.rollout.Restore(state);
  EXPECT_TRUE(sink.records.empty()) << "playing again publishes nothing";
  EXPECT_EQ(successor.rollout.State(), state);
  successor.Load({7, 20});
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(successor.rollout.TryStep());
  EXPECT_EQ(sink.records, decltype(sink.records)(sink_.records.begin() + static_cast<long>(before),
                                                 sink_.records.end()));
  EXPECT_EQ(successor.rollout.env_steps(), rollout().env_steps());
}

// Ornstein-Uhlenbeck noise carries something over from step to step.
TEST_F(RolloutTest, GoesOnBitForBitWithNoiseThatHasAMemory) {
  Config config = SmallConfig(1);
  config.exploration.kind = "ou";
  parts_.emplace(run_.path(), sink_, config, kFirstEnv);
  parts_->Load({7, 20});
  Step(2);
  const RolloutState state = rollout().State();
  Step(1);
  const TemporaryFolder run;
  FakeSink sink(parts_->spec);
  RolloutParts successor(run.path(), sink, config, kFirstEnv);
  successor.Load({7, 20});
  successor.rollout.Restore(state);
  ASSERT_TRUE(successor.rollout.TryStep());
  const auto action = sink_.layout().Action(sink_.Bytes(3));
  EXPECT_THAT(sink.layout().Action(sink.Bytes(0)), ElementsAre(action[0], action[1]));
}

// The share of an actor out of four of 10 random steps: three.
class WarmUpTest : public RolloutTest {
 protected:
  WarmUpTest() {
    config_ = SmallConfig(1);
    config_.actors = 4;
    config_.exploration.random_steps = 10;
    config_.exploration.kind = "gaussian";
    config_.exploration.sigma = Schedule::Constant(0);  // actions of the policy can be recognized
    parts_.emplace(run_.path(), sink_, config_, kFirstEnv);
  }
  // Whether the record's action is uniformly random, judged by the numbers in the record.
  bool Random(size_t record) const {
    const float action = sink_.layout().Action(sink_.Bytes(record))[0];
    const bool by_policy = std::abs(action - std::tanh(0.3F)) < 1e-6F;
    EXPECT_EQ(sink_.Header(record).weights_session, by_policy ? 7u : 0u);
    EXPECT_EQ(sink_.Header(record).weights_update, by_policy ? 20u : 0u);
    return !by_policy;
  }

  Config config_;
};

TEST_F(WarmUpTest, EndsWithTheActorsShare) {
  parts_->Load({7, 20}, /*run_env_steps=*/9);
  Step(5);
  EXPECT_TRUE(Random(1));
  EXPECT_TRUE(Random(2));
  EXPECT_TRUE(Random(3));
  EXPECT_FALSE(Random(5)) << "record 4 is the second episode's reset";
  EXPECT_FALSE(Random(6));
}

TEST_F(WarmUpTest, EndsWhenTheRunHasHadItsRandomSteps) {
  Step(1);
  parts_->Load({7, 20}, /*run_env_steps=*/10);
  Step(1);
  EXPECT_TRUE(Random(1));
  EXPECT_FALSE(Random(2)) << "an actor that joins late does not begin anew";
}

TEST_F(WarmUpTest, BeforeAnyWeightsItGoesOnBeyondTheShare) {
  Step(5);
  EXPECT_TRUE(Random(5));
  EXPECT_TRUE(Random(6));
}

TEST_F(RolloutTest, TimeOfAUsersCodeIsNoTimeOfShoals) {
  Start(2);
  Step(2);
  const StageSeconds own = rollout().seconds();
  EXPECT_FALSE(own.users);
  EXPECT_GT(own.physics, 0);
  EXPECT_EQ(own.user_code, 0);
  EXPECT_EQ(own.conversion, 0);

  std::vector<std::unique_ptr<worlds::Environment>> environments;
  for (const double share : {0.25e-9, 0.5e-9}) {
    auto environment = std::make_unique<CountingEnvironment>();
    environment->users_share = share;
    environments.push_back(std::move(environment));
  }
  Rollout hosted(Rollout::Options::Of(parts_->config, kFirstEnv), parts_->spec,
                 std::move(environments), parts_->made, sink_, parts_->selector);
  ASSERT_TRUE(hosted.TryStep());
  const StageSeconds users = hosted.seconds();
  EXPECT_TRUE(users.users);
  EXPECT_EQ(users.physics, 0);
  EXPECT_DOUBLE_EQ(users.user_code, 0.75e-9);
  EXPECT_GT(users.conversion, 0);
}

TEST_F(RolloutTest, AStateOfOtherEnvironmentsIsRefusedNamingBoth) {
  Start(2);
  RolloutState state = rollout().State();
  state.episodes.pop_back();
  try {
    rollout().Restore(state);
    FAIL() << "restored one environment's state into two";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("1 environments"), HasSubstr("has 2")));
  }
}

}  // namespace
}  // namespace shoal::actor
