// SPDX-License-Identifier: Apache-2.0
// Rollouts with environments whose resets or steps give numbers that are not finite.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <optional>

#include "actor/loop/rollout.h"
#include "common/base/error.h"
#include "tests/actor/loop/rollout_parts.h"

namespace shoal::actor {
namespace {

using testing::HasSubstr;

// Three environments whose episodes last three steps; some are faulty.
class FaultyRolloutTest : public testing::Test {
 protected:
  static constexpr int kEnvs = 3;
  using Faulty = std::function<bool(uint64_t key, int step)>;

  void Start(const Faulty& faulty, double max_share = 1) {
    config_.max_faulty_share = max_share;
    std::vector<std::unique_ptr<worlds::Environment>> environments;
    for (int e = 0; e < kEnvs; ++e) {
      auto environment = std::make_unique<CountingEnvironment>();
      environment->faulty = faulty;
      environments.push_back(std::move(environment));
    }
    rollout_.emplace(Rollout::Options::Of(config_, kFirstEnv), spec_, std::move(environments),
                     made_, sink_, selector_);
  }
  uint64_t KeyOf(uint32_t env, uint32_t episode) const {
    return StreamKey(static_cast<uint64_t>(config_.seed), StreamRole::kTrainEnvironment, env,
                     episode);
  }
  // By environment: the records' (episode, index).
  std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> Played() const {
    std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> played;
    for (size_t i = 0; i < sink_.records.size(); ++i) {
      const RecordHeader& header = sink_.Header(i);
      played[header.env].emplace_back(header.episode, header.index);
    }
    return played;
  }

  const TemporaryFolder run_;
  Config config_ = SmallConfig(kEnvs);
  const ObservationSpec spec_ = CountingEnvironment().spec();
  FakeSink sink_{spec_};
  SequenceLog made_{run_.path(), /*actor=*/0, /*session=*/10, kFirstEnv, kEnvs};
  ActionSelector selector_{config_, spec_, kEnvs};
  std::optional<Rollout> rollout_;
};

TEST_F(FaultyRolloutTest, AFaultyStepIsNotRecordedAndTheNextEpisodesFirstTakesItsPlace) {
  const uint64_t faulty_key = KeyOf(kFirstEnv + 1, 0);
  Start([=](uint64_t key, int step) { return key == faulty_key && step == 2; });
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(rollout_->TryStep());
  using P = std::vector<std::pair<uint32_t, uint32_t>>;
  auto played = Played();
  // The first two of the others are cut short where episodes begin together: after 1 and 2 steps.
  EXPECT_EQ(played[kFirstEnv + 1], (P{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {1, 2}}))
      << "the episode ends with its first step";
  EXPECT_EQ(rollout_->env_steps(), 9u);
  EXPECT_EQ(rollout_->faults().total(), 1u);
  EXPECT_EQ(rollout_->faults().count(worlds::FaultCause::kDiverged), 1u);
  size_t steps = 0;
  for (size_t i = 0; i < sink_.records.size(); ++i) {
    EXPECT_EQ(RecordFault(sink_.layout(), sink_.Bytes(i)), nullptr) << i;
    steps += sink_.Header(i).kind == RecordKind::kStep;
    EXPECT_EQ(sink_.sequences[i], i + 1) << "made without a hole";
  }
  EXPECT_EQ(steps, rollout_->env_steps());
  EXPECT_EQ(made_.made(), sink_.records.size());
}

TEST_F(FaultyRolloutTest, WhateverIsFaultyEveryVectorStepHasOneStepOfEachEnvironment) {
  // A fifth of the episodes, at any step or at the reset.
  Start(
      [](uint64_t key, int step) { return key % 5 == 0 && step == static_cast<int>(key / 5 % 4); });
  constexpr int kManySteps = 200;
  for (int i = 1; i <= kManySteps; ++i) {
    ASSERT_TRUE(rollout_->TryStep());
    ASSERT_EQ(rollout_->vector_steps(), i);
  }
  EXPECT_GT(rollout_->faults().total(), 20u);
  for (auto& [env, played] : Played()) {
    size_t steps = 0;
    std::pair<uint32_t, uint32_t> last{0, 0};
    for (size_t i = 0; i < played.size(); ++i) {
      const auto [episode, index] = played[i];
      steps += index > 0;
      if (index == 0) {
        EXPECT_TRUE(i == 0 || episode > last.first) << "an episode begins anew";
      } else {
        EXPECT_EQ(episode, last.first);
        EXPECT_EQ(index, last.second + 1);
      }
      last = played[i];
    }
    EXPECT_EQ(steps, size_t{kManySteps}) << env;
  }
}

TEST_F(FaultyRolloutTest, WithoutRoomTheOwedStepWaitsAndTheStateKnowsIt) {
  const uint64_t faulty_key = KeyOf(kFirstEnv + 2, 0);
  // Room for the resets and steps of three environments, then for one record more.
  class Narrow final : public RecordSink {
   public:
    explicit Narrow(FakeSink* sink) : sink_(sink) {}
    size_t Room() const override { return left; }
    uint8_t* BeginRecord() override { return sink_->BeginRecord(); }
    void EndRecord(uint64_t sequence) override {
      --left;
      sink_->EndRecord(sequence);
    }
    size_t left = 6;

   private:
    FakeSink* sink_;
  };
  Narrow narrow(&sink_);
  std::vector<std::unique_ptr<worlds::Environment>> environments;
  for (int e = 0; e < kEnvs; ++e) {
    auto environment = std::make_unique<CountingEnvironment>();
    environment->faulty = [=](uint64_t key, int step) { return key == faulty_key && step == 1; };
    environments.push_back(std::move(environment));
  }
  const TemporaryFolder run;
  SequenceLog made(run.path(), 0, 10, kFirstEnv, kEnvs);
  Rollout rollout(Rollout::Options::Of(config_, kFirstEnv), spec_, std::move(environments), made,
                  narrow, selector_);
  EXPECT_FALSE(rollout.TryStep()) << "three resets, two steps: one record left, a reset wants two";
  EXPECT_EQ(rollout.env_steps(), 0u);
  EXPECT_EQ(sink_.records.size(), 5u);
  const RolloutState state = rollout.State();
  EXPECT_FALSE(state.episodes[0].owes || state.episodes[1].owes);
  EXPECT_TRUE(state.episodes[2].owes);
  WriteRolloutState(run.path(), 0, state);
  EXPECT_EQ(TakeRolloutState(run.path(), 0), state) << "the file has it";
  narrow.left = 2;
  EXPECT_TRUE(rollout.TryStep());
  EXPECT_EQ(rollout.env_steps(), 3u);
  EXPECT_EQ(sink_.records.size(), 7u) << "one reset and one step alone";
  EXPECT_EQ(sink_.Header(6).env, kFirstEnv + 2);
  EXPECT_EQ(sink_.Header(6).episode, 1u);
}

TEST_F(FaultyRolloutTest, WhereFaultsAreNoExceptionItEndsWithTheFaultsLine) {
  Start([](uint64_t, int step) { return step == 2; }, /*max_share=*/0.05);
  try {
    for (int i = 0; i < 100; ++i) rollout_->TryStep();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 3);
    EXPECT_THAT(error.what(), HasSubstr("a fault at step 2; 11 of the last"));
  }
}

TEST_F(FaultyRolloutTest, ATaskThatCannotBeginIsAnErrorWhateverShareIsAllowed) {
  Start([](uint64_t, int step) { return step == 0; }, /*max_share=*/1);
  try {
    rollout_->TryStep();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 3);
    EXPECT_THAT(error.what(), HasSubstr("100 episodes in a row cannot begin"));
  }
}

TEST_F(FaultyRolloutTest, FaultyEpisodesAreLoggedAsFailures) {
  const uint64_t faulty_key = KeyOf(kFirstEnv + 2, 0);  // the episode without a cut
  Start([=](uint64_t key, int step) { return key == faulty_key && step == 3; });
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(rollout_->TryStep());
  ASSERT_GE(rollout_->episodes().count(), 1u);
  EXPECT_EQ(rollout_->episodes().SuccessRate(), 0);
}

}  // namespace
}  // namespace shoal::actor
