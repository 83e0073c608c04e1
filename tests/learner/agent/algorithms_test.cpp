// SPDX-License-Identifier: Apache-2.0
// Properties of every algorithm of the list.
#include "learner/agent/algorithms.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/base/error.h"
#include "common/config/algorithm_kind.h"
#include "common/config/config_io.h"
#include "common/config/on_policy.h"
#include "common/config/priorities.h"
#include "common/config/sequences.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const Algorithm& algorithm : Algorithms()) names.emplace_back(algorithm.name);
  return names;
}

class EachAlgorithm : public testing::TestWithParam<std::string> {
 protected:
  EachAlgorithm() { config_.learner.algorithm = GetParam(); }

  const Algorithm& algorithm() const {
    return *std::ranges::find(Algorithms(), GetParam(), &Algorithm::name);
  }

  RandomBatch Batch(uint64_t key) const {
    return {SmallSpec(),
            BatchOptions{.batch = config_.learner.batch,
                         .horizon = HorizonOf(config_),
                         .rollout = LearnsOnPolicy(config_),
                         .probabilities = HasPriorities(config_.replay)},
            key};
  }

  Config config_ = SmallConfig();
};

TEST_P(EachAlgorithm, ReportsItsFiguresAndNoOthers) {
  if (config_.learner.algorithm == "sac") config_.sac.aux = {"goal"};
  if (AlgorithmKindOf(config_).priorities) config_.replay.priorities = "proportional";
  const auto agent = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  std::set<std::string_view> declared, reported;
  for (const Figure* figure : algorithm().figures) {
    EXPECT_TRUE(declared.insert(figure->name).second) << figure->name << " is declared twice";
    EXPECT_FALSE(figure->meaning.empty()) << figure->name;
    EXPECT_EQ(FindFigure(figure->name)->name, figure->name);
  }
  for (int u = 0; u < 10; ++u) {
    const RandomBatch batch = Batch(uint64_t(u));
    const UpdateOutcome outcome = agent->Update(batch.View());
    ASSERT_TRUE(outcome.finite);
    for (const auto& [figure, value] : outcome.figures.entries()) {
      reported.insert(figure->name);
      EXPECT_TRUE(std::isfinite(value)) << figure->name;
    }
  }
  EXPECT_EQ(reported, declared);
}

TEST_P(EachAlgorithm, TakesItsLearningRateFromTheRunsEnvSteps) {
  config_.learner.rate_factor = {.start = 1, .end = 0, .env_steps = 1'000};
  const auto agent = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  const auto update = [&](uint64_t key, uint64_t stored_steps) {
    const RandomBatch batch = Batch(key);
    BatchView view = batch.View();
    view.stored_steps = stored_steps;
    const UpdateOutcome outcome = agent->Update(view);
    EXPECT_TRUE(outcome.finite);
    return Get(outcome, kLearningRate) / config_.learner.learning_rate;
  };
  if (LearnsOnPolicy(config_)) {  // by the steps it learned from: 6 a rollout
    EXPECT_NEAR(update(1, 0), 0.994, 1e-9);
    EXPECT_NEAR(update(2, 0), 0.988, 1e-9);
    for (uint64_t u = 2; u < 166; ++u) update(u, 0);
  } else {
    EXPECT_NEAR(update(1, 0), 1, 1e-9);
    EXPECT_NEAR(update(2, 250), 0.75, 1e-9);
  }
  const nn::TensorMap before = agent->PolicyTensors();
  EXPECT_EQ(update(3, 1'000), 0);
  EXPECT_EQ(update(4, 1'001), 0);
  EXPECT_THAT(Differences(before, agent->PolicyTensors()), testing::IsEmpty());
}

TEST_P(EachAlgorithm, EndsEveryStageOfAnUpdate) {
  const auto agent = MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
  const RandomBatch batch = Batch(1);
  std::map<UpdateStage, int> ends;
  agent->Update(batch.View(), [&](UpdateStage stage) { ++ends[stage]; });
  for (const UpdateStage stage :
       {UpdateStage::kForward, UpdateStage::kBackward, UpdateStage::kOptimiser}) {
    EXPECT_GT(ends[stage], 0) << int(stage);
  }
}

// The key refuses other names before anything starts; the factory, were it asked.
TEST_P(EachAlgorithm, IsAValueOfTheKey) {
  Config config;
  ApplyAssignments({"learner.algorithm=" + GetParam()}, &config);
  EXPECT_EQ(config.learner.algorithm, GetParam());
}

// By the parameters it keeps.
TEST_P(EachAlgorithm, HasTheCriticsThatItsLineSays) {
  const auto tensors = MakeAgent(config_, SmallSpec(), nn::Precision::kF32)->AllTensors();
  int critics = 0;
  while (tensors.contains(fmt::format("critic.q{}.output.weight", critics + 1))) ++critics;
  EXPECT_EQ(algorithm().critics, critics);
  EXPECT_EQ(CriticsOf(config_), critics);
  EXPECT_EQ(critics == 0, AlgorithmKindOf(config_).on_policy);
}

// Adding one is a line here and a line there.
TEST(Algorithms, AreThoseThatTheConfigurationKnows) {
  std::vector<std::string> known;
  for (const AlgorithmKind& kind : AlgorithmKinds()) known.emplace_back(kind.name);
  EXPECT_EQ(Names(), known);
}

TEST(Algorithms, OthersAreRefusedNamingThem) {
  Config config = SmallConfig();
  config.learner.algorithm = "alchemy";
  const auto refused = ThrowsMessage<Error>(testing::AllOf(
      HasSubstr("learner.algorithm"), HasSubstr("alchemy"), HasSubstr(Names().front())));
  EXPECT_THAT([&] { MakeAgent(config, SmallSpec(), nn::Precision::kF32); }, refused);
  EXPECT_THAT([&] { ApplyAssignments({"learner.algorithm=alchemy"}, &config); }, refused);
}

TEST(UpdateFigures, KeepTheirOrderAndWhatIsMissingIsAbsent) {
  UpdateFigures figures;
  figures.Set(kQMean, 2);
  figures.Set(kCriticLoss, 0);
  ASSERT_EQ(figures.entries().size(), 2u);
  EXPECT_EQ(figures.entries()[0].figure->name, "q_mean");
  EXPECT_EQ(figures.Get(kCriticLoss), 0);
  EXPECT_FALSE(figures.Get(kEntropy));
  figures.Replace(kQMean, 3);
  EXPECT_EQ(figures.Get(kQMean), 3);
  EXPECT_EQ(figures.entries().size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(All, EachAlgorithm, testing::ValuesIn(Names()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace shoal::learner
