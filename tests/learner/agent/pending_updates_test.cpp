// SPDX-License-Identifier: Apache-2.0
// An agent whose engine has updates in flight is the agent that waits for each, byte for byte; only
// its outcomes come later.
#include "learner/agent/pending_updates.h"

#include <gmock/gmock.h>

#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "learner/engine/cpu_engine.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/engine/deferring_engine.h"

namespace shoal::learner {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr size_t kDelay = 3;

struct DeferringCase {
  std::string name;
  std::function<void(Config*)> set;
};

void PrintTo(const DeferringCase& each, std::ostream* out) { *out << each.name; }

void ExpectSame(const UpdateOutcome& outcome, const UpdateOutcome& expected) {
  EXPECT_EQ(outcome.finite, expected.finite);
  ASSERT_EQ(outcome.figures.entries().size(), expected.figures.entries().size());
  for (size_t i = 0; i < outcome.figures.entries().size(); ++i) {
    const auto &entry = outcome.figures.entries()[i], &other = expected.figures.entries()[i];
    EXPECT_EQ(entry.figure, other.figure);
    EXPECT_THAT(entry.value, testing::NanSensitiveDoubleEq(other.value)) << entry.figure->name;
  }
}

class PendingUpdatesTest : public testing::TestWithParam<DeferringCase> {
 protected:
  PendingUpdatesTest() {
    config_.learner.normalise_vectors = true;
    GetParam().set(&config_);
    const Algorithm& algorithm = FindAlgorithm(config_.learner.algorithm);
    waiting_ = algorithm.make(config_, SmallSpec(), &engines_[0]);
    deferring_ = algorithm.make(config_, SmallSpec(), &deferred_);
  }

  // Both agents learn from batch `key`, of which `change` may spoil a number.
  void Submit(
      uint64_t key, const std::function<void(BatchView)>& change = [](BatchView) {}) {
    const RandomBatch batch(SmallSpec(), config_.learner.batch, key);
    change(batch.View());
    expected_.push_back(waiting_->Update(batch.View()));
    Keep(deferring_->Submit(batch.View(), [](UpdateStage) {}));
  }
  void Keep(std::vector<UpdateOutcome> outcomes) {
    std::ranges::move(outcomes, std::back_inserter(outcomes_));
  }
  void ExpectSameAgents() {
    EXPECT_EQ(deferring_->updates(), waiting_->updates());
    EXPECT_THAT(Differences(deferring_->AllTensors(), waiting_->AllTensors()), IsEmpty());
  }

  Config config_ = SmallConfig();
  nn::Replica alone_[2];
  CpuEngine engines_[2]{{nn::Precision::kF32, config_.learner.batch, &alone_[0]},
                        {nn::Precision::kF32, config_.learner.batch, &alone_[1]}};
  DeferringEngine deferred_{&engines_[1], kDelay};
  std::unique_ptr<Agent> waiting_, deferring_;
  std::vector<UpdateOutcome> expected_, outcomes_;
};

TEST_P(PendingUpdatesTest, OutcomesFollowInOrderAndTheAgentIsTheSame) {
  constexpr size_t kSubmitted = 8;
  for (size_t u = 0; u < kSubmitted; ++u) {
    Submit(u);
    EXPECT_EQ(deferring_->updates(), u + 1) << "an update in flight counts";
    EXPECT_THAT(outcomes_, SizeIs(u < kDelay ? 0 : u + 1 - kDelay));
  }
  EXPECT_EQ(deferred_.in_flight(), kDelay);
  Keep(deferring_->Finish());
  EXPECT_THAT(deferring_->Finish(), IsEmpty());
  ASSERT_THAT(outcomes_, SizeIs(kSubmitted));
  for (size_t u = 0; u < kSubmitted; ++u) ExpectSame(outcomes_[u], expected_[u]);
  EXPECT_NE(Get(outcomes_[0], kCriticLoss), Get(outcomes_[1], kCriticLoss));
  ExpectSameAgents();
}

TEST_P(PendingUpdatesTest, AnUpdateThatIsNotFiniteLeavesNothingOfThoseBehindIt) {
  const std::function<void(BatchView)> spoils[] = {
      [](BatchView view) { view.obs_vector[3] = NAN; },
      [](BatchView view) { view.reward[2] = 1e25f; },
  };
  uint64_t done = 0;
  for (const auto& spoil : spoils) {
    for (uint64_t u = 0; u < 2; ++u) Submit(++done);
    Submit(100, spoil);
    // These are in flight behind it; the agent that waits never sees them.
    for (uint64_t u = 0; u < kDelay; ++u) {
      const RandomBatch batch(SmallSpec(), config_.learner.batch, 200 + u);
      Keep(deferring_->Submit(batch.View(), [](UpdateStage) {}));
    }
    ASSERT_THAT(outcomes_, SizeIs(expected_.size()));
    EXPECT_FALSE(outcomes_.back().finite);
    ExpectSame(outcomes_.back(), expected_.back());
    EXPECT_EQ(deferring_->updates(), done);
    EXPECT_THAT(deferring_->Finish(), IsEmpty());
    ExpectSameAgents();
  }
  for (uint64_t u = 0; u < 2; ++u) Submit(++done);
  Submit(101, spoils[1]);
  Keep(deferring_->Finish());
  ASSERT_THAT(outcomes_, SizeIs(expected_.size()));
  for (size_t u = 0; u < expected_.size(); ++u) ExpectSame(outcomes_[u], expected_[u]);
  EXPECT_EQ(deferring_->updates(), done);
  ExpectSameAgents();
}

const DeferringCase kDeferringCases[] = {
    {"sac", [](Config* config) { config->learner.actor_period = 2; }},
    {"sac_separate",
     [](Config* config) {
       config->network.encoders = "separate";
       config->learner.target_period = 2;
     }},
    {"td3", [](Config* config) { config->learner.algorithm = "td3"; }},
    {"ddpg", [](Config* config) { config->learner.algorithm = "ddpg"; }},
    {"drqv2", [](Config* config) { config->learner.algorithm = "drqv2"; }},
};

INSTANTIATE_TEST_SUITE_P(Of, PendingUpdatesTest, testing::ValuesIn(kDeferringCases),
                         [](const auto& test) { return test.param.name; });

// An update of a rollout looks at numbers between its minibatches, so it waits for each.
TEST(PendingUpdates, PpoWaitsForEachMinibatch) {
  Config config = SmallConfig();
  config.learner.algorithm = "ppo";
  config.ppo.target_kl = 1e-2;
  nn::Replica alone[2];
  CpuEngine engines[2]{{nn::Precision::kF32, config.learner.batch, &alone[0]},
                       {nn::Precision::kF32, config.learner.batch, &alone[1]}};
  DeferringEngine deferred(&engines[1], kDelay);
  const Algorithm& algorithm = FindAlgorithm("ppo");
  const auto waiting = algorithm.make(config, SmallSpec(), &engines[0]);
  const auto deferring = algorithm.make(config, SmallSpec(), &deferred);
  for (uint64_t u = 0; u < 3; ++u) {
    const RandomBatch rollout(SmallSpec(), BatchOptions{.batch = 12, .rollout = true}, u);
    ExpectSame(deferring->Update(rollout.View()), waiting->Update(rollout.View()));
    EXPECT_EQ(deferred.in_flight(), 0u);
  }
  EXPECT_THAT(Differences(deferring->AllTensors(), waiting->AllTensors()), IsEmpty());
}

}  // namespace
}  // namespace shoal::learner
