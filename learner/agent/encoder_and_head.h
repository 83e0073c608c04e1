// SPDX-License-Identifier: Apache-2.0
// Building block of the algorithms' networks: an encoder, if there are pixels, and a head above the
// encoder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/encoder_module.h"
#include "common/spec/observation_spec.h"

namespace shoal::learner {

// Makes an encoder; returns null without pixels. `name`: see nn::PlanEncoder.
std::unique_ptr<nn::EncoderModule> MakeEncoder(const NetworkConfig& network,
                                               const ObservationSpec& spec, nn::Module::Use use,
                                               const nn::ModuleContext& context,
                                               const std::string& name = "encoder");

// Returns the parameter sets of encoder and head, for one optimiser. `encoder` may be null. Borrows
// the two modules.
std::vector<nn::ParameterSet*> SetsOf(nn::EncoderModule* encoder, nn::Module* head);

}  // namespace shoal::learner
