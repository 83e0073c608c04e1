// SPDX-License-Identifier: Apache-2.0
#include "learner/device/device_agent.h"

#include <gmock/gmock.h>

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/encoder_module.h"
#include "common/nn/encoders/encoder_kind.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

std::string Refusal(const Config& config) {
  try {
    CheckComputes(config);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), int(ErrorKind::kUsage));
    return error.what();
  }
  return "";
}

TEST(DeviceAgent, EveryPresetAndAlgorithmButOneIsComputed) {
  for (const std::string& name : ListPresets()) {
    const Config config = LoadPreset(name);
    EXPECT_EQ(Refusal(config).empty(), config.learner.algorithm != "mrq") << name;
  }
  for (const Algorithm& algorithm : Algorithms()) {
    Config config = SmallConfig();
    config.learner.algorithm = algorithm.name;
    EXPECT_EQ(Refusal(config).empty(), algorithm.name != "mrq") << algorithm.name;
  }
}

TEST(DeviceAgent, QuantilesAreRefused) {
  Config config = SmallConfig();
  config.sac.quantiles = 5;
  EXPECT_EQ(Refusal(config), "sac.quantiles = 5: a device does not compute quantiles, expected 0");
}

TEST(DeviceAgent, ResidualBlocksAreRefused) {
  Config config = SmallConfig();
  config.network.blocks = 1;
  EXPECT_EQ(Refusal(config),
            "network.blocks = 1: a device does not compute residual blocks, expected 0");
}

// A device refuses no encoder, so it must have the layers of each.
TEST(DeviceAgent, EveryEncoderIsBuilt) {
  for (const nn::EncoderKind& kind : nn::EncoderKinds()) {
    Config config = SmallConfig();
    config.learner.batch = 2;
    config.network = {};
    config.network.encoder = kind.name;
    config.network.initialisation = "pytorch";  // fast
    ObservationSpec spec = SmallSpec();
    spec.height = spec.width = 84;
    HostDevice device;
    DeviceEngine engine(&device, nn::Precision::kBf16, config.learner.batch);
    const nn::EncoderModule module(nn::PlanEncoder(config.network, spec),
                                   nn::Module::Use::kTraining, engine.modules());
    EXPECT_EQ(module.features().columns(), nn::PlanEncoder(config.network, spec).output().size())
        << kind.name;
  }
}

TEST(DeviceAgent, LearnsTheBandit) {
  HostDevice device;
  const auto make = [&](const Config& config, const ObservationSpec& spec,
                        nn::Precision precision) {
    return MakeDeviceAgent(config, spec, precision, &device);
  };
  EXPECT_LT(BanditError(Config(), make), 0.1f);
}

}  // namespace
}  // namespace shoal::learner::device
