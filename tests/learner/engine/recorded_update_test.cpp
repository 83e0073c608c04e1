// SPDX-License-Identifier: Apache-2.0
// An update could be recorded once and repeated: which operations it consists of, on which arrays
// and in which order, and which convolutions its networks run, is the same whatever the numbers
// are.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
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
  const BatchOptions options_{.batch = config_.learner.batch, .privileged = {"object"}};
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
    // An update that is not finite leaves nothing behind, so the next one is the same update.
    const nn::TensorMap before = agent_->AllTensors();
    const Recording finite = Record();
    ASSERT_TRUE(finite.finite);
    ASSERT_GT(finite.operations.size(), 8u);
    ASSERT_GT(finite.convolutions, 0u);
    agent_->Restore(before, "test");
    expect_same(finite, "a batch", 0, [](BatchView view) { view.obs_vector[3] = NAN; });
    expect_same(finite, "a loss", 0, [](BatchView view) { view.reward[2] = 1e25f; });
    if (MovesActor(finite)) expect_same(finite, "a step", kLargeSteps, [](BatchView) {});
    EXPECT_EQ(Record().operations, finite.operations) << "and it goes on";
  }
}

const Variant kVariants[] = {
    {"sac", [](Config*) {}},
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
};

INSTANTIATE_TEST_SUITE_P(Of, RecordedUpdateTest, testing::ValuesIn(kVariants),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace shoal::learner
