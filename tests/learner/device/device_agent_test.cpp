// SPDX-License-Identifier: Apache-2.0
#include "learner/device/device_agent.h"

#include <gmock/gmock.h>

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

std::string Refusal(const Config& config, const ObservationSpec& spec) {
  try {
    CheckComputes(config, spec);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), int(ErrorKind::kUsage));
    return error.what();
  }
  return "";
}

TEST(DeviceAgent, RefusesWhatADeviceDoesNotCompute) {
  Config config = SmallConfig();
  EXPECT_EQ(Refusal(config, SmallSpec()), "");
  config.network.filters.clear();
  config.network.strides.clear();
  config.network.encoder = "resnet18";
  ObservationSpec spec = SmallSpec();
  spec.height = spec.width = 64;
  EXPECT_EQ(
      Refusal(config, spec),
      "network.encoder = resnet18: a device does not compute this encoder, expected compact | "
      "drq | mrq | nature | spatial_softmax");
  WithoutPixels(&spec);
  EXPECT_EQ(Refusal(config, spec), "");
}

// A preset that only the CPU computes would leave the GPU unused with learner.device=auto.
TEST(DeviceAgent, EveryPresetIsComputed) {
  ObservationSpec spec = SmallSpec();
  spec.height = spec.width = 84;
  for (const std::string& name : ListPresets()) {
    EXPECT_EQ(Refusal(LoadPreset(name), spec), "") << name;
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
