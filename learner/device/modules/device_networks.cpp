// SPDX-License-Identifier: Apache-2.0
#include "learner/device/modules/device_networks.h"

#include "learner/device/modules/device_encoder.h"
#include "learner/device/modules/device_heads.h"

namespace shoal::learner::device {
namespace {

const DeviceFeatures* FeaturesOf(const nn::Features* features) {
  return features == nullptr ? nullptr : &DeviceFeatures::Of(*features);
}

}  // namespace

std::unique_ptr<nn::EncoderNetwork> DeviceNetworks::MakeEncoder(const nn::NetworkPlan& plan,
                                                                nn::ParameterSet::Use use,
                                                                nn::ParameterSet* parameters) {
  return std::make_unique<DeviceEncoder>(workspace_, plan, use, parameters);
}

std::unique_ptr<nn::CriticNetwork> DeviceNetworks::MakeCritic(const nn::HeadPlan& plan,
                                                              const nn::Features* features,
                                                              bool trains_encoder,
                                                              nn::ParameterSet::Use use,
                                                              nn::ParameterSet* parameters) {
  return std::make_unique<DeviceCritic>(workspace_, plan, FeaturesOf(features), trains_encoder, use,
                                        parameters);
}

std::unique_ptr<nn::ActorNetwork> DeviceNetworks::MakeActor(const nn::ActorPlan& plan,
                                                            const nn::Features* features,
                                                            bool trains_encoder,
                                                            nn::ParameterSet::Use use,
                                                            nn::ParameterSet* parameters) {
  return std::make_unique<DeviceActor>(workspace_, plan, FeaturesOf(features), trains_encoder, use,
                                       parameters);
}

std::unique_ptr<nn::ReadoutNetwork> DeviceNetworks::MakeReadout(const std::string& name,
                                                                const nn::Features& trunk,
                                                                nn::ParameterSet* parameters) {
  return std::make_unique<DeviceReadout>(workspace_, name, DeviceFeatures::Of(trunk), parameters);
}

}  // namespace shoal::learner::device
