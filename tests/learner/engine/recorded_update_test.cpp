// SPDX-License-Identifier: Apache-2.0
// The operations of an update, their arrays and order, and the convolutions of its networks do not
// depend on the numbers, so an update could be recorded once and repeated.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "learner/engine/cpu_engine.h"
#include "tests/common/nn/primitive_trace.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/engine/recording_engine.h"

namespace shoal::learner {
namespace {

struct Variant {
  std::string name;
  std::function<void(Config*)> set;
  float reward = 1e25f;  // of a loss that is not finite
};

void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

ObservationSpec Spec() {
  ObservationSpec spec = SmallSpec();
  spec.blocks.push_back({"object", 3, /*observed=*/false});
  return spec;
}

// At this env step of a run a step of the critic is so large that the actor's loss is not finite.
constexpr uint64_t kLargeSteps = 1000;

class RecordedUpdateTest : public testing::TestWithParam<Variant> {
 protected:
  RecordedUpdateTest() {
    config_.learner.rate_factor = Schedule{.start = 1, .end = 1e40, .env_steps = kLargeSteps};
    config_.sac.aux = {"object"};
    GetParam().set(&config_);
    agent_ = FindAlgorithm(config_.learner.algorithm).make(config_, Spec(), &recording_);
  }

  // The operations of one update with these numbers.
  struct Recording {
    std::vector<std::string> operations;
    size_t convolutions = 0;
    bool finite = false;
  };
  Recording Record(uint64_t stored_steps, const std::function<void(BatchView)>& change) {
    const RandomBatch other(Spec(), options_, agent_->updates() + stored_steps);
    std::ranges::copy(other.View().obs_frames, batch_.View().obs_frames.begin());
    std::ranges::copy(other.View().obs_vector, batch_.View().obs_vector.begin());
    std::ranges::copy(other.View().reward, batch_.View().reward.begin());
    BatchView view = batch_.View();
    view.stored_steps = stored_steps;
    change(view);
    Recording recording;
    const nn::PrimitiveTrace trace([&] { recording.finite = agent_->Update(view).finite; });
    recording.convolutions = trace.Count(nn::PrimitiveTrace::Part::kConvolutions);
    recording.operations = recording_.TakeOperations();
    return recording;
  }
  static bool MovesActor(const Recording& recording) {
    return std::ranges::any_of(recording.operations, [](const std::string& operation) {
      return operation.find("ActorLoss") != std::string::npos;
    });
  }
  Recording Record() {
    return Record(0, [](BatchView) {});
  }

  Config config_ = SmallConfig();
  const BatchOptions options_{
      .batch = config_.learner.batch, .probabilities = true, .privileged = {"object"}};
  const RandomBatch batch_{Spec(), options_, 1};  // the memory of all batches
  nn::Replica alone_;
  CpuEngine engine_{nn::Precision::kF32, config_.learner.batch, &alone_};
  RecordingEngine recording_{&engine_};
  std::unique_ptr<Agent> agent_;
};

TEST_P(RecordedUpdateTest, ItsOperationsDoNotDependOnNumbers) {
  const auto expect_same = [this](const Recording& expected, const char* what,
                                  uint64_t stored_steps,
                                  const std::function<void(BatchView)>& change) {
    const Recording recording = Record(stored_steps, change);
    EXPECT_FALSE(recording.finite) << what;
    EXPECT_EQ(recording.operations, expected.operations) << what;
    EXPECT_EQ(recording.convolutions, expected.convolutions) << what;
  };
  for (int update = 0; update < 4; ++update) {
    // An update that is not finite changes no state, so the next update is the same.
    const nn::TensorMap before = agent_->AllTensors();
    const Recording finite = Record();
    ASSERT_TRUE(finite.finite);
    ASSERT_GT(finite.operations.size(), 8u);
    ASSERT_GT(finite.convolutions, 0u);
    agent_->Restore(before, "test");
    expect_same(finite, "a batch", 0, [](BatchView view) { view.obs_vector[3] = NAN; });
    expect_same(finite, "a loss", 0, [](BatchView view) { view.reward[2] = GetParam().reward; });
    if (MovesActor(finite)) expect_same(finite, "a step", kLargeSteps, [](BatchView) {});
    EXPECT_EQ(Record().operations, finite.operations) << "and it goes on";
  }
}

const Variant kVariants[] = {
    {"sac", [](Config*) {}},
    {"sac_with_priorities", [](Config* config) { config->replay.priorities = "proportional"; }},
    {"sac_separate",
     [](Config* config) {
       config->network.encoders = "separate";
       config->network.target_encoder = true;
       config->learner.actor_period = 2;
       config->learner.target_period = 2;
       config->learner.max_grad_norm = 0.5;
     }},
    {"sac_asymmetric",
     [](Config* config) {
       config->sac.critic_blocks = true;
       config->learner.normalise_vectors = true;
     }},
    {"sac_ensemble",
     [](Config* config) {
       config->sac.critics = 4;
       config->sac.target_critics = 2;
       config->sac.actor_value = "mean";
       config->learner.actor_period = 2;
     }},
    // Losses and gradients grow linearly with errors.
    {"sac_quantiles",
     [](Config* config) {
       config->sac.quantiles = 5;
       config->learner.learning_rate = 10;
     },
     3e38f},
    {"td3",
     [](Config* config) {
       config->learner.algorithm = "td3";
       config->learner.actor_period = 2;
       config->learner.target_period = 2;
       config->sac.aux.clear();
     }},
    {"ddpg",
     [](Config* config) {
       config->learner.algorithm = "ddpg";
       config->sac.aux.clear();
     }},
    {"drqv2",
     [](Config* config) {
       config->learner.algorithm = "drqv2";
       config->learner.actor_period = 1;
       config->drqv2.noise = Schedule{.start = 1, .end = 0.1, .env_steps = kLargeSteps};
       config->sac.aux.clear();
     }},
};

// Rates follow a schedule from update to update, and steps are counted: both are in the engine's
// memory, so no number that the host gives to an operation changes.
TEST_P(RecordedUpdateTest, EachOneIsTheOneAPeriodBefore) {
  config_.learner.rate_factor = Schedule{.start = 1, .end = 0.5, .env_steps = kLargeSteps};
  agent_ = FindAlgorithm(config_.learner.algorithm).make(config_, Spec(), &recording_);
  const auto period = size_t(config_.learner.actor_period);
  std::vector<Recording> recordings;
  std::vector<nn::TensorMap> states;
  for (uint64_t update = 0; update < 6; ++update) {
    recordings.push_back(Record(100 * update, [](BatchView) {}));
    ASSERT_TRUE(recordings.back().finite);
    states.push_back(agent_->AllTensors());
  }
  for (size_t update = period; update < recordings.size(); ++update) {
    EXPECT_EQ(recordings[update].operations, recordings[update - period].operations) << update;
    EXPECT_THAT(Differences(states[update], states[update - period], "critic."),
                testing::Not(testing::IsEmpty()));
  }
}

INSTANTIATE_TEST_SUITE_P(Of, RecordedUpdateTest, testing::ValuesIn(kVariants),
                         [](const auto& test) { return test.param.name; });

// On policy an update of a rollout is a sequence of updates of the engine: some that compute values
// without a step, then one for each minibatch.
class RecordedMinibatchTest : public testing::TestWithParam<const char*> {
 protected:
  RecordedMinibatchTest() {
    config_.learner.algorithm = "ppo";
    config_.learner.normalise_vectors = true;
    config_.learner.rate_factor = Schedule{.start = 1, .end = 0.5, .env_steps = 100};
    config_.ppo.networks = GetParam();
    config_.ppo.clip = Schedule{.start = 0.2, .end = 0.1, .env_steps = 100};
    config_.ppo.target_kl = 1e-2;
    config_.learner.learning_rate = 3e-3;
    config_.ppo.epochs = 3;
  }

  // The operations from each Begin to its End.
  using Operations = std::vector<std::string>;
  struct Recording {
    std::vector<Operations> values, minibatches;
    bool finite = false;
    double steps = 0;
  };
  Recording Record(Agent* agent, const BatchView& rollout) {
    recording_.TakeOperations();
    const UpdateOutcome outcome = agent->Update(rollout);
    Recording result{.values = {},
                     .minibatches = {},
                     .finite = outcome.finite,
                     .steps = outcome.figures.Get(*FindFigure("minibatches")).value_or(-1)};
    Operations update;
    for (const std::string& operation : recording_.TakeOperations()) {
      if (update.empty() && !operation.starts_with("Begin")) continue;
      update.push_back(operation);
      if (operation != "End") continue;
      const bool steps = std::ranges::any_of(
          update, [](const std::string& each) { return each.starts_with("Step"); });
      (steps ? result.minibatches : result.values).push_back(std::move(update));
      update.clear();
    }
    return result;
  }

  Config config_ = SmallConfig();
  nn::Replica alone_;
  CpuEngine engine_{nn::Precision::kF32, config_.learner.batch, &alone_};
  RecordingEngine recording_{&engine_};
};

TEST_P(RecordedMinibatchTest, ItsOperationsDoNotDependOnNumbers) {
  const auto agent = FindAlgorithm("ppo").make(config_, SmallSpec(), &recording_);
  const BatchOptions options{.batch = 12, .rollout = true};
  std::vector<Operations> all, values;
  bool held = false, stepped = false;
  const auto record = [&](uint64_t key, float log_prob) {
    const RandomBatch rollout(SmallSpec(), options, key);
    const BatchView view = rollout.View();
    for (size_t b = 0; b < view.rows(); ++b) {
      const std::span<const float> u = view.drawn_action.subspan(2 * b, 2);
      // An untrained policy has means of about 0 and deviations of 1.
      view.log_prob[b] = log_prob - 1.837877f - (u[0] * u[0] + u[1] * u[1]) / 2;
    }
    Recording recording = Record(agent.get(), rollout.View());
    std::ranges::copy(recording.minibatches, std::back_inserter(all));
    std::ranges::copy(recording.values, std::back_inserter(values));
    held = held || recording.steps < double(recording.minibatches.size());
    stepped = stepped || recording.steps > 0;
    return recording.finite;
  };
  for (uint64_t update = 0; update < 4; ++update) ASSERT_TRUE(record(update, 0));
  ASSERT_TRUE(held && stepped) << "choose another target_kl";
  ASSERT_FALSE(record(9, -3e38f)) << "a loss";
  ASSERT_TRUE(record(10, 0));
  ASSERT_GE(all.size(), 6u);
  ASSERT_GT(all[0].size(), 8u);
  EXPECT_THAT(all, testing::Each(all[0]));
  ASSERT_GE(values.size(), 12u);  // two passes, and one for next observations at ends of episodes
  EXPECT_THAT(values, testing::Each(values[0]));
}

INSTANTIATE_TEST_SUITE_P(Of, RecordedMinibatchTest, testing::Values("separate", "shared"));

}  // namespace
}  // namespace shoal::learner
