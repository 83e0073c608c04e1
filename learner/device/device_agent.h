// SPDX-License-Identifier: Apache-2.0
// Agents that compute with a device.
#pragma once

#include <memory>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/device/device.h"

namespace shoal::learner::device {

// Throws Error (kUsage), one line, if DeviceEngine does not compute the configuration: it names the
// key, its value and what is computed.
void CheckComputes(const Config& config);

// Makes the agent of config.learner.algorithm, with one engine on the device, which it borrows.
// Throws the errors of FindAlgorithm and CheckComputes.
std::unique_ptr<Agent> MakeDeviceAgent(const Config& config, const ObservationSpec& spec,
                                       nn::Precision precision, Device* device);

}  // namespace shoal::learner::device
