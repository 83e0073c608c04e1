// SPDX-License-Identifier: Apache-2.0
// Several replicas give the same agent as one replica, within rounding, and the same bits each
// time.
#include "learner/agent/replicated_agent.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "common/config/priorities.h"
#include "common/config/sequences.h"
#include "common/nn/parallel.h"
#include "learner/agent/sac/sac_agent.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/engine/deferring_engine.h"

namespace shoal::learner {
namespace {

using nn::Precision;
using nn::TensorMap;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

struct Case {
  std::string name;
  std::function<void(Config*)> set;
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

// Whose policy sees the frames and the goal alone.
ObservationSpec Spec() {
  ObservationSpec spec = SmallSpec();
  spec.blocks.push_back({"object", 2, /*observed=*/false});
  return spec;
}

class ReplicatedAgentTest : public testing::TestWithParam<Case> {
 protected:
  ReplicatedAgentTest() {
    config_.learner.actor_period = config_.learner.target_period = 1;
    GetParam().set(&config_);
  }
  ~ReplicatedAgentTest() override { nn::SetThreads(1); }

  std::unique_ptr<Agent> Of(int replicas) const {
    nn::SetThreads(replicas);
    return MakeAgent(config_, Spec(), Precision::kF32);
  }
  RandomBatch Batch(uint64_t key) const {
    const bool told = !config_.sac.aux.empty() || config_.sac.critic_blocks;
    return {Spec(),
            BatchOptions{.batch = config_.learner.batch,
                         .copies = config_.replay.copies,
                         .horizon = HorizonOf(config_),
                         .probabilities = HasPriorities(config_.replay),
                         .privileged = told ? std::vector<std::string>{"object"}
                                            : std::vector<std::string>{}},
            key};
  }
  UpdateOutcome Update(Agent* agent, uint64_t key) const {
    return agent->Update(Batch(key).View());
  }

  Config config_ = SmallConfig();
};

// Targets as after many updates, so that each network is seen where it belongs. Gradients are read
// off Adam's first moments, which were 0 before.
TEST_P(ReplicatedAgentTest, GradientsAndFiguresAreThoseOfTheWholeBatch) {
  const TensorMap start = Perturbed(Of(1)->AllTensors(), "target");
  for (const int replicas : {2, 3, 4, 5}) {  // 4 and 5 do not divide the six transitions
    const auto one = Of(1), several = Of(replicas);
    one->Restore(start, "test");
    several->Restore(start, "test");
    const UpdateOutcome expected = Update(one.get(), 3), got = Update(several.get(), 3);
    ASSERT_EQ(got.figures.entries().size(), expected.figures.entries().size());
    for (size_t i = 0; i < got.figures.entries().size(); ++i) {
      const auto &figure = got.figures.entries()[i], &other = expected.figures.entries()[i];
      EXPECT_EQ(figure.figure, other.figure);
      EXPECT_NEAR(figure.value, other.value, 1e-5 + 1e-5 * std::abs(other.value))
          << figure.figure->name;
    }
    ASSERT_EQ(got.errors.size(), expected.errors.size());
    for (size_t b = 0; b < got.errors.size(); ++b) {
      EXPECT_NEAR(got.errors[b], expected.errors[b], 1e-5) << b;
    }
    const TensorMap after = several->AllTensors(), reference = one->AllTensors();
    size_t compared = 0;
    for (const auto& [name, tensor] : reference) {
      if (!name.starts_with("adam.m.")) continue;
      const std::vector<float> x = Floats(reference, name), y = Floats(after, name);
      float most = 0;
      for (const float value : x) most = std::max(most, std::abs(value));
      EXPECT_GT(most, 0) << name;
      for (size_t j = 0; j < x.size(); ++j, ++compared) {
        ASSERT_NEAR(y[j], x[j], 1e-5f * most + 1e-8f) << name << " " << replicas;
      }
    }
    EXPECT_GT(compared, 500u);
  }
}

TEST_P(ReplicatedAgentTest, RunsRepeatBitForBitAndGoOnFromACheckpoint) {
  const auto a = Of(4), b = Of(4), restored = Of(4);
  for (uint64_t u = 0; u < 3; ++u) {
    ASSERT_TRUE(Update(a.get(), u).finite);
    ASSERT_TRUE(Update(b.get(), u).finite);
  }
  EXPECT_THAT(Differences(a->AllTensors(), b->AllTensors()), IsEmpty());
  restored->Restore(a->AllTensors(), "test");
  EXPECT_EQ(restored->updates(), 3u);
  for (uint64_t u = 3; u < 6; ++u) {
    Update(a.get(), u);
    Update(restored.get(), u);
  }
  EXPECT_THAT(Differences(a->AllTensors(), restored->AllTensors()), IsEmpty());
}

const Case kCases[] = {
    {"sac", [](Config*) {}},
    {"sac_with_an_ensemble",
     [](Config* config) {
       config->sac.critics = 4;
       config->sac.target_critics = 2;
       config->sac.actor_value = "mean";
     }},
    {"sac_with_quantiles", [](Config* config) { config->sac.quantiles = 5; }},
    {"sac_with_copies",
     [](Config* config) {
       config->learner.batch = 12;
       config->replay.copies = 2;
     }},
    {"sac_with_fewer_shifts",
     [](Config* config) {
       config->learner.batch = 12;
       config->replay.copies = 2;
       config->replay.target_shifts = 1;
     }},
    {"sac_with_further_encoders",
     [](Config* config) {
       config->network.encoders = "separate";
       config->network.target_encoder = true;
     }},
    {"sac_told_more",
     [](Config* config) {
       config->sac.critic_blocks = true;
       config->sac.aux = {"object"};
       config->learner.normalise_vectors = true;
     }},
    // Layouts of weights that several replicas write.
    {"sac_wide",
     [](Config* config) {
       config->network.hidden = {64, 256};
     }},
    {"sac_with_blocks",
     [](Config* config) {
       config->network.hidden = {16};
       config->network.blocks = 1;
     }},
    {"sac_clipped", [](Config* config) { config->learner.max_grad_norm = 0.1; }},
    {"sac_with_priorities",
     [](Config* config) {
       config->learner.batch = 12;
       config->replay.copies = 2;
       config->replay.priorities = "proportional";
     }},
    {"td3_with_lap",
     [](Config* config) {
       config->learner.algorithm = "td3";
       config->replay.priorities = "lap";
     }},
    {"td3", [](Config* config) { config->learner.algorithm = "td3"; }},
    {"ddpg", [](Config* config) { config->learner.algorithm = "ddpg"; }},
    {"drqv2", [](Config* config) { config->learner.algorithm = "drqv2"; }},
    {"mrq",
     [](Config* config) {
       config->learner.algorithm = "mrq";
       config->mrq.horizon = 2;
       config->mrq.period = 2;
       config->network.state_hidden = {10, 64};
       config->network.hidden = {12, 256};
     }},
};

INSTANTIATE_TEST_SUITE_P(Of, ReplicatedAgentTest, testing::ValuesIn(kCases),
                         [](const auto& test) { return test.param.name; });

// Replicas with access to each, whose engines have up to `delay` updates in flight.
class Replicas {
 public:
  explicit Replicas(int count, const Config& config = SmallConfig(), size_t delay = 0)
      : whole(MakeReplicatedAgent(config, Precision::kF32, count, [&](Engine* engine) {
          auto agent = MakeSacAgent(config, SmallSpec(), &engines.emplace_back(engine, delay));
          each.push_back(agent.get());
          return agent;
        })) {}

  std::deque<DeferringEngine> engines;
  std::vector<Agent*> each;
  const std::unique_ptr<Agent> whole;
};

TEST(ReplicatedAgent, ReplicasStayEqualBitForBit) {
  const Replicas replicas(3);
  const TensorMap before = replicas.whole->AllTensors();
  for (uint64_t u = 0; u < 10; ++u) {
    const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, u);
    ASSERT_TRUE(replicas.whole->Update(batch.View()).finite);
  }
  const TensorMap after = replicas.whole->AllTensors();
  EXPECT_THAT(Differences(before, after), Not(IsEmpty()));
  for (const Agent* agent : replicas.each) {
    EXPECT_THAT(Differences(agent->AllTensors(), after), IsEmpty());
  }
}

// An agent that records which threads make and run it.
struct ThreadRecorder final : Agent {
  std::vector<UpdateOutcome> Submit(const BatchView&, const OnStageEnd&) override {
    ran = std::this_thread::get_id();
    return {UpdateOutcome()};
  }
  uint64_t updates() const override { return 0; }
  TensorMap PolicyTensors() const override { return {}; }
  TensorMap AveragedPolicyTensors() const override { return {}; }
  TensorMap AllTensors() const override { return {}; }
  void Restore(const TensorMap&, const std::string&) override {}

  const std::thread::id made = std::this_thread::get_id();
  std::thread::id ran;
};

// Memory is on the NUMA node of the thread that writes it first.
TEST(ReplicatedAgent, EachReplicaIsMadeByTheThreadThatRunsIt) {
  std::vector<ThreadRecorder*> each;
  const auto whole = MakeReplicatedAgent(SmallConfig(), Precision::kF32, 3, [&](Engine*) {
    auto agent = std::make_unique<ThreadRecorder>();
    each.push_back(agent.get());
    return agent;
  });
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 0);
  whole->Update(batch.View());
  std::set<std::thread::id> threads;
  for (const ThreadRecorder* agent : each) {
    EXPECT_EQ(agent->ran, agent->made);
    threads.insert(agent->made);
  }
  EXPECT_EQ(threads.size(), 3u);
}

TEST(ReplicatedAgent, WhatOneReplicaCannotUseChangesNone) {
  const Replicas replicas(2);
  const TensorMap before = replicas.whole->AllTensors();
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 9);
  batch.View().reward[5] = 1e25f;  // of the second; its squared error is not finite
  EXPECT_FALSE(replicas.whole->Update(batch.View()).finite);
  batch.View().reward[5] = std::nanf("");
  EXPECT_FALSE(replicas.whole->Update(batch.View()).finite);
  for (const Agent* agent : replicas.each) {
    EXPECT_THAT(Differences(agent->AllTensors(), before), IsEmpty());
  }
  EXPECT_THAT(Differences(replicas.whole->AllTensors(), before), IsEmpty());
  batch.View().reward[5] = 0;
  EXPECT_TRUE(replicas.whole->Update(batch.View()).finite) << "and it goes on";
}

// The actor's loss shows a step of the critic that must be taken back, in all replicas.
TEST(ReplicatedAgent, NonFiniteActorLossTakesTheCriticsStepBackInAll) {
  Config config = SmallConfig();
  config.learner.learning_rate = 1e37;
  const Replicas replicas(2, config);
  const TensorMap before = replicas.whole->AllTensors();
  const RandomBatch batch(SmallSpec(), config.learner.batch, 1);
  const UpdateOutcome outcome = replicas.whole->Update(batch.View());
  EXPECT_TRUE(std::isfinite(Get(outcome, kCriticLoss)));
  EXPECT_FALSE(outcome.finite);
  for (const Agent* agent : replicas.each) {
    EXPECT_THAT(Differences(agent->AllTensors(), before), IsEmpty());
  }
  EXPECT_THAT(Differences(replicas.whole->AllTensors(), before), IsEmpty());
}

TEST(ReplicatedAgent, ReplicasWithUpdatesInFlightAgree) {
  const Replicas waiting(2), deferring(2, SmallConfig(), /*delay=*/2);
  std::vector<bool> finite;
  const auto keep = [&](const std::vector<UpdateOutcome>& outcomes) {
    for (const UpdateOutcome& outcome : outcomes) finite.push_back(outcome.finite);
  };
  for (uint64_t u = 0; u < 6; ++u) {
    const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, u);
    if (u == 4) batch.View().reward[5] = 1e25f;  // of the second
    keep(deferring.whole->Submit(batch.View(), [](UpdateStage) {}));
    if (u < 5) waiting.whole->Update(batch.View());
  }
  EXPECT_THAT(finite, testing::ElementsAre(true, true, true, true));
  keep(deferring.whole->Finish());
  EXPECT_THAT(finite, testing::ElementsAre(true, true, true, true, false));
  EXPECT_EQ(deferring.whole->updates(), 4u);
  for (const Agent* agent : deferring.each) {
    EXPECT_THAT(Differences(agent->AllTensors(), waiting.whole->AllTensors()), IsEmpty());
  }
  const RandomBatch next(SmallSpec(), SmallConfig().learner.batch, 6);
  EXPECT_EQ(Get(deferring.whole->Update(next.View()), kCriticLoss),
            Get(waiting.whole->Update(next.View()), kCriticLoss));
}

TEST(ReplicatedAgent, NothingLeavesItWhileUpdatesAreInFlight) {
  const Replicas replicas(1, SmallConfig(), /*delay=*/2);
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 4);
  const TensorMap before = replicas.whole->AllTensors();
  replicas.whole->Submit(batch.View(), [](UpdateStage) {});
  EXPECT_DEATH((void)replicas.whole->AllTensors(), "1 updates are in flight");
  EXPECT_DEATH((void)replicas.whole->PolicyTensors(), "in flight");
  EXPECT_DEATH((void)replicas.whole->AveragedPolicyTensors(), "in flight");
  EXPECT_DEATH(replicas.whole->Restore(before, "test"), "in flight");
  replicas.whole->Finish();
  EXPECT_THAT(Differences(replicas.whole->AllTensors(), before), Not(IsEmpty()));
}

TEST(ReplicatedAgent, ACheckpointIsOfNoNumberOfReplicas) {
  const Replicas one(1), three(3);
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 4);
  ASSERT_TRUE(one.whole->Update(batch.View()).finite);
  three.whole->Restore(one.whole->AllTensors(), "test");
  EXPECT_EQ(three.whole->updates(), 1u);
  for (const Agent* agent : three.each) {
    EXPECT_THAT(Differences(agent->AllTensors(), one.whole->AllTensors()), IsEmpty());
  }
  EXPECT_THAT(Differences(three.whole->AllTensors(), one.whole->AllTensors()), IsEmpty());
}

TEST(ReplicasOf, AreOneWhereTheWholeBatchHasToStayTogether) {
  Config config = SmallConfig();
  EXPECT_EQ(ReplicasOf(config, SmallSpec(), 2), 2);
  EXPECT_EQ(DescribeThreads(config, SmallSpec(), 2, 4), "2 threads, a replica each");
  EXPECT_EQ(DescribeThreads(config, SmallSpec(), 3, 2),
            "3 threads, a replica each, more than there are cores");
  EXPECT_EQ(ReplicasOf(config, SmallSpec(), 5), 5);
  EXPECT_THAT([&] { ReplicasOf(config, SmallSpec(), 7); },
              ThrowsMessage<Error>(HasSubstr("learner.threads = 7")));
  config.network.encoder = "resnet18";
  config.network.filters.clear();
  config.network.strides.clear();
  EXPECT_EQ(ReplicasOf(config, SmallSpec(), 4), 1);
  EXPECT_EQ(DescribeThreads(config, SmallSpec(), 2, 2),
            "2 threads that share each layer: resnet18 normalises over the batch");
  config.learner.algorithm = "ppo";
  EXPECT_EQ(DescribeThreads(config, SmallSpec(), 2, 2),
            "2 threads that share each layer: ppo knows no replicas");
  EXPECT_EQ(DescribeThreads(config, SmallSpec(), 1, 2), "1 thread");
}

}  // namespace
}  // namespace shoal::learner
