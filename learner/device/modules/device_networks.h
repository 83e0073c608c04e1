// SPDX-License-Identifier: Apache-2.0
// Maker of the networks of an engine on a device.
#pragma once

#include <memory>
#include <string>

#include "common/nn/networks.h"
#include "learner/device/workspace.h"

namespace shoal::learner::device {

class DeviceNetworks final : public nn::NetworkMaker {
 public:
  // Borrows the workspace.
  explicit DeviceNetworks(Workspace* workspace) : workspace_(workspace) {}

  std::unique_ptr<nn::EncoderNetwork> MakeEncoder(const nn::NetworkPlan& plan,
                                                  nn::ParameterSet::Use use,
                                                  nn::ParameterSet* parameters) override;
  std::unique_ptr<nn::CriticNetwork> MakeCritic(const nn::HeadPlan& plan,
                                                const nn::Features* features, bool trains_encoder,
                                                nn::ParameterSet::Use use,
                                                nn::ParameterSet* parameters) override;
  std::unique_ptr<nn::ActorNetwork> MakeActor(const nn::ActorPlan& plan,
                                              const nn::Features* features, bool trains_encoder,
                                              nn::ParameterSet::Use use,
                                              nn::ParameterSet* parameters) override;
  std::unique_ptr<nn::ReadoutNetwork> MakeReadout(const std::string& name,
                                                  const nn::Features& trunk,
                                                  nn::ParameterSet* parameters) override;

 private:
  Workspace* const workspace_;
};

}  // namespace shoal::learner::device
