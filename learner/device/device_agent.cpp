// SPDX-License-Identifier: Apache-2.0
#include "learner/device/device_agent.h"

#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/wrapped_agent.h"
#include "learner/device/device_engine.h"

namespace shoal::learner::device {
namespace {

// An algorithm's agent, and its engine.
class DeviceAgent final : public WrappedAgent {
 public:
  DeviceAgent(const Config& config, const ObservationSpec& spec, nn::Precision precision,
              Device* device)
      : engine_(device, precision, config.learner.batch) {
    agent_ = FindAlgorithm(config.learner.algorithm).make(config, spec, &engine_);
  }
  ~DeviceAgent() override { agent_.reset(); }  // it borrows the engine
  DeviceAgent(const DeviceAgent&) = delete;
  DeviceAgent& operator=(const DeviceAgent&) = delete;

 private:
  DeviceEngine engine_;
};

}  // namespace

void CheckComputes(const Config& config) {
  const Algorithm& algorithm = FindAlgorithm(config.learner.algorithm);
  if (!algorithm.on_devices) {
    std::vector<std::string_view> names;
    for (const Algorithm& other : Algorithms()) {
      if (other.on_devices) names.push_back(other.name);
    }
    throw UsageError(
        "learner.algorithm = {}: a device does not compute this algorithm, expected {}",
        algorithm.name, fmt::join(names, " | "));
  }
  if (config.sac.quantiles != 0) {
    throw UsageError("sac.quantiles = {}: a device does not compute quantiles, expected 0",
                     config.sac.quantiles);
  }
  if (config.network.blocks != 0) {
    throw UsageError("network.blocks = {}: a device does not compute residual blocks, expected 0",
                     config.network.blocks);
  }
}

std::unique_ptr<Agent> MakeDeviceAgent(const Config& config, const ObservationSpec& spec,
                                       nn::Precision precision, Device* device) {
  CheckComputes(config);
  return std::make_unique<DeviceAgent>(config, spec, precision, device);
}

}  // namespace shoal::learner::device
