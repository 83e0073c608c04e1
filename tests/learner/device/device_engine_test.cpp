// SPDX-License-Identifier: Apache-2.0
// Agents that compute with a device, in host memory, beside agents of the CPU's engine with the
// same batches and random draws.
#include "learner/device/device_engine.h"

#include <gmock/gmock.h>

#include <iterator>
#include <vector>

#include "common/config/priorities.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

class DeviceEngineTest : public testing::TestWithParam<AgentCase> {
 protected:
  DeviceEngineTest() { GetParam().set(&config_, &spec_); }

  RandomBatch Batch(uint64_t key) const {
    BatchOptions options{.batch = config_.learner.batch,
                         .copies = config_.replay.copies,
                         .probabilities = HasPriorities(config_.replay)};
    for (const BlockSpec& block : spec_.blocks) {
      if (!block.observed) options.privileged.push_back(block.name);
    }
    return RandomBatch(spec_, options, key);
  }

  // Compares with the CPU's engine in f32: first losses, and networks and moments after all
  // updates.
  void ExpectLikeTheCpu(nn::Precision precision, double first, double later, double moments) {
    OnCpu cpu(config_, spec_, nn::Precision::kF32);
    OnDevice device(config_, spec_, precision);
    ExpectNear(device.agent->AllTensors(), cpu.agent->AllTensors(), 1e-12, 1e-12);
    for (uint64_t u = 0; u < GetParam().updates; ++u) {
      const RandomBatch batch = Batch(u);
      BatchView view = batch.View();
      view.stored_steps = 500 * u;  // schedules change from update to update
      const UpdateOutcome expected = cpu.agent->Update(view);
      const UpdateOutcome outcome = device.agent->Update(view);
      ASSERT_TRUE(expected.finite && outcome.finite) << u;
      ASSERT_EQ(outcome.errors.size(), expected.errors.size());
      if (u == 0) ExpectFigures(outcome, expected, first);
      for (size_t b = 0; u == 0 && b < expected.errors.size(); ++b) {
        EXPECT_NEAR(outcome.errors[b], expected.errors[b], first * (1 + expected.errors[b])) << b;
      }
    }
    ExpectNear(device.agent->AllTensors(), cpu.agent->AllTensors(), later, moments,
               GetParam().without_effect);
    EXPECT_LE(device.engine.recorded(), 8);
  }

  Config config_ = SmallConfig();
  ObservationSpec spec_ = SmallSpec();
};

TEST_P(DeviceEngineTest, LearnsLikeTheCpuInF32) {
  ExpectLikeTheCpu(nn::Precision::kF32, 1e-4, 1e-3, 1e-2);
}

// Rounding differs from f32 in every update, so the distance grows.
TEST_P(DeviceEngineTest, LearnsInBf16LikeTheCpuInF32) {
  ExpectLikeTheCpu(nn::Precision::kBf16, 2e-2, 6e-2, 0);
}

// Each kind of update is recorded once for each of the two landings, and then replayed.
TEST_P(DeviceEngineTest, RepeatsItselfBitForBitWithUpdatesInFlight) {
  HostDevice::Options backward = kPadding;
  backward.order = kernels::HostOrder::kBackward;
  backward.first = Lane::kCopies;
  OnDevice waiting(config_, spec_, nn::Precision::kBf16);
  OnDevice flying(config_, spec_, nn::Precision::kBf16, 2, backward);
  std::vector<UpdateOutcome> outcomes;
  std::vector<std::vector<float>> errors;
  const auto keep = [&](std::vector<UpdateOutcome> known) {
    std::ranges::move(known, std::back_inserter(outcomes));
  };
  for (uint64_t u = 0; u < 12; ++u) {
    const RandomBatch batch = Batch(u);
    errors.push_back(waiting.agent->Update(batch.View()).errors);
    keep(flying.agent->Submit(batch.View(), [](UpdateStage) {}));
    EXPECT_THAT(outcomes, SizeIs(u < 2 ? 0 : u - 1));
  }
  const int64_t recorded = flying.engine.recorded();
  for (uint64_t u = 12; u < 24; ++u) {
    const RandomBatch batch = Batch(u);
    errors.push_back(waiting.agent->Update(batch.View()).errors);
    keep(flying.agent->Submit(batch.View(), [](UpdateStage) {}));
  }
  keep(flying.agent->Finish());
  ASSERT_THAT(outcomes, SizeIs(24));
  for (size_t u = 0; u < 24; ++u) EXPECT_EQ(outcomes[u].errors, errors[u]) << u;
  EXPECT_EQ(flying.engine.recorded(), recorded);
  EXPECT_THAT(Differences(flying.agent->AllTensors(), waiting.agent->AllTensors()), IsEmpty());
}

// A copy of the policy is begun with updates in flight, and further updates are submitted before it
// is read.
TEST_P(DeviceEngineTest, ACopyOfThePolicyHasTheValuesOfItsUpdate) {
  OnDevice waiting(config_, spec_, nn::Precision::kBf16);
  OnDevice flying(config_, spec_, nn::Precision::kBf16, 2);
  const auto submit = [&](uint64_t u) {
    flying.agent->Submit(Batch(u).View(), [](UpdateStage) {});
  };
  for (uint64_t u = 0; u < 12; u += 4) {
    for (uint64_t v = u; v < u + 2; ++v) {
      submit(v);
      waiting.agent->Update(Batch(v).View());
    }
    const size_t before = flying.device.waiting();
    nn::PendingTensors copy = flying.agent->CopyPolicyTensors();
    EXPECT_GT(before, 0u);
    EXPECT_GT(flying.device.waiting(), before) << "copies were added and nothing was run";
    const nn::TensorMap expected = waiting.agent->PolicyTensors();
    for (uint64_t v = u + 2; v < u + 4; ++v) {
      submit(v);
      waiting.agent->Update(Batch(v).View());
    }
    EXPECT_THAT(Differences(copy.Take(), expected), IsEmpty());
    EXPECT_FALSE(Differences(waiting.agent->PolicyTensors(), expected).empty());
  }
  flying.agent->Finish();
  EXPECT_THAT(Differences(flying.agent->AllTensors(), waiting.agent->AllTensors()), IsEmpty());
  EXPECT_THAT(Differences(flying.agent->PolicyTensors(), waiting.agent->PolicyTensors()),
              IsEmpty());
}

// A number that is not finite, in the batch or in a loss, leaves no trace, and neither do the
// updates in flight behind it.
TEST_P(DeviceEngineTest, AnUpdateThatIsNotFiniteHasNoEffect) {
  OnDevice clean(config_, spec_, nn::Precision::kF32),
      spoilt(config_, spec_, nn::Precision::kF32, 2);
  const auto submit = [](OnDevice* side, const RandomBatch& batch) {
    return side->agent->Submit(batch.View(), [](UpdateStage) {});
  };
  uint64_t key = 0;
  for (const bool in_batch : {true, false}) {
    for (int u = 0; u < 3; ++u, ++key) {
      clean.agent->Update(Batch(key).View());
      submit(&spoilt, Batch(key));
    }
    const RandomBatch bad = Batch(100);
    // Huber's function of 1e25, and its gradient, are finite.
    const float large = config_.replay.priorities == "lap" ? 3e38f : 1e25f;
    bad.View().reward[2] = in_batch ? NAN : large;
    submit(&spoilt, bad);
    submit(&spoilt, Batch(101));
    const std::vector<UpdateOutcome> known = submit(&spoilt, Batch(102));
    ASSERT_THAT(known, SizeIs(1));
    EXPECT_FALSE(known[0].finite);
    EXPECT_EQ(spoilt.agent->updates(), clean.agent->updates());
    EXPECT_THAT(spoilt.agent->Finish(), IsEmpty());
    EXPECT_THAT(Differences(spoilt.agent->AllTensors(), clean.agent->AllTensors()), IsEmpty());
  }
}

TEST_P(DeviceEngineTest, CheckpointsMoveBetweenDeviceAndCpu) {
  constexpr auto kF32 = nn::Precision::kF32;
  OnDevice first(config_, spec_, kF32);
  OnCpu expected(config_, spec_, kF32);
  for (uint64_t u = 0; u < 5; ++u) {
    first.agent->Update(Batch(u).View());
    expected.agent->Update(Batch(u).View());
  }
  OnCpu second(config_, spec_, kF32);
  const nn::TensorMap written = first.agent->AllTensors();
  second.agent->Restore(written, "test");
  EXPECT_THAT(Differences(second.agent->AllTensors(), written), IsEmpty());
  OnDevice third(config_, spec_, kF32);
  for (uint64_t u = 5; u < 10; ++u) {
    second.agent->Update(Batch(u).View());
    expected.agent->Update(Batch(u).View());
  }
  third.agent->Restore(second.agent->AllTensors(), "test");
  EXPECT_THAT(Differences(third.agent->AllTensors(), second.agent->AllTensors()), IsEmpty());
  for (uint64_t u = 10; u < 15; ++u) {
    third.agent->Update(Batch(u).View());
    expected.agent->Update(Batch(u).View());
  }
  EXPECT_EQ(third.agent->updates(), 15u);
  ExpectNear(third.agent->AllTensors(), expected.agent->AllTensors(), 1e-3, 1e-2,
             GetParam().without_effect);
}

void SetEncoder(const char* encoder, int side, Config* config, ObservationSpec* spec) {
  config->network.encoder = encoder;
  config->network.filters.clear();
  config->network.strides.clear();
  spec->height = spec->width = side;
}

const AgentCase kAgentCases[] = {
    {"sac", [](Config*, ObservationSpec*) {}},
    {"sac_vectors", [](Config*, ObservationSpec* spec) { WithoutPixels(spec); }},
    {"sac_drq",
     [](Config* config, ObservationSpec* spec) {
       SetEncoder("drq", 16, config, spec);
       config->learner.actor_period = 2;
       config->replay.copies = 2;
     }},
    {"sac_nature",
     [](Config* config, ObservationSpec* spec) {
       SetEncoder("nature", 36, config, spec);
       config->network.features = 24;
     },
     // A ReLU that rounding switches in one engine makes later updates differ, and this network has
     // no LayerNorm that would keep numbers away from 0.
     20},
    {"sac_spatial_softmax",
     [](Config* config, ObservationSpec* spec) {
       SetEncoder("spatial_softmax", 24, config, spec);
       config->learner.actor_period = 2;
     },
     200,
     // The points do not change if a number is added to all pixels of a channel.
     "encoder.conv1.bias"},
    {"sac_separate",
     [](Config* config, ObservationSpec*) {
       config->network.encoders = "separate";
       config->network.target_encoder = true;
       config->learner.actor_period = 2;
       config->learner.target_period = 2;
       config->learner.max_grad_norm = 0.5;
       config->network.log_std = "clamped";
     }},
    {"sac_asymmetric",
     [](Config* config, ObservationSpec* spec) {
       spec->blocks.push_back({"object", 3, /*observed=*/false});
       config->sac.critic_blocks = true;
       config->sac.aux = {"object"};
       config->learner.normalise_vectors = true;
     }},
    {"sac_plain_layers",
     [](Config* config, ObservationSpec*) {
       config->network.layer_norm = false;
       config->network.trunk = "relu";
       config->network.activation = "tanh";
       config->network.hidden = {10, 12, 9};
     }},
    {"sac_with_elu",
     [](Config* config, ObservationSpec*) {
       config->network.layer_norm = false;
       config->network.trunk = "elu";
       config->network.activation = "elu";
     }},
    {"sac_ensemble",
     [](Config* config, ObservationSpec* spec) {
       WithoutPixels(spec);
       config->sac.critics = 5;
       config->sac.target_critics = 2;
       config->sac.actor_value = "mean";
       config->learner.actor_period = 2;
     }},
    {"sac_smallest_of_three", [](Config* config, ObservationSpec*) { config->sac.critics = 3; }},
    {"sac_with_priorities",
     [](Config* config, ObservationSpec*) {
       config->replay.priorities = "proportional";
       config->replay.copies = 2;
       // Two critics are nearly equal at a row of this batch. Rounding chooses the smaller one.
       config->sac.actor_value = "mean";
     }},
    {"td3_with_lap",
     [](Config* config, ObservationSpec* spec) {
       config->learner.algorithm = "td3";
       config->replay.priorities = "lap";
       WithoutPixels(spec);
     }},
    {"td3", [](Config* config, ObservationSpec*) { config->learner.algorithm = "td3"; }},
    {"ddpg",
     [](Config* config, ObservationSpec*) {
       config->learner.algorithm = "ddpg";
       config->learner.mean_penalty = 0.1;
       config->learner.normalise_vectors = true;
     }},
    {"drqv2",
     [](Config* config, ObservationSpec*) {
       config->learner.algorithm = "drqv2";
       config->learner.actor_period = 1;
     }},
};

INSTANTIATE_TEST_SUITE_P(Of, DeviceEngineTest, testing::ValuesIn(kAgentCases),
                         [](const auto& test) { return test.param.name; });

// Encoders whose updates are slow in host memory. residual_learner_test.cpp has the other checks of
// their layers, with a smaller encoder.
struct LargeEncoder {
  const char* name;
  int height, width;
};

class LargeEncoderTest : public testing::TestWithParam<LargeEncoder> {};

TEST_P(LargeEncoderTest, TheFirstUpdateIsLikeThatOfTheCpu) {
  Config config = SmallConfig();
  ObservationSpec spec = SmallSpec();
  SetEncoder(GetParam().name, GetParam().height, &config, &spec);
  spec.width = GetParam().width;
  config.network.initialisation = "pytorch";  // fast
  config.learner.batch = 3;
  OnCpu cpu(config, spec, nn::Precision::kF32);
  OnDevice device(config, spec, nn::Precision::kF32);
  const RandomBatch batch(spec, config.learner.batch, 1);
  const UpdateOutcome expected = cpu.agent->Update(batch.View());
  const UpdateOutcome outcome = device.agent->Update(batch.View());
  ASSERT_TRUE(expected.finite && outcome.finite);
  ExpectFigures(outcome, expected, 1e-4);
  ExpectNear(device.agent->PolicyTensors(), cpu.agent->PolicyTensors(), 1e-3, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, LargeEncoderTest,
                         testing::Values(LargeEncoder{"alexnet", 63, 63},
                                         LargeEncoder{"resnet18", 33, 18}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace shoal::learner::device
