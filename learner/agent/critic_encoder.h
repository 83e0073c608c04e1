// The encoder that a critic's loss trains (and nobody else's): SAC, TD3 and DDPG have it alike.
#pragma once

#include <memory>
#include <vector>

#include "common/config/config.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/spec/observation_spec.h"

namespace shoal::learner {

// Null without pixels.
std::unique_ptr<nn::EncoderModule> MakeCriticEncoder(const NetworkConfig& network,
                                                     const ObservationSpec& spec,
                                                     const nn::ModuleContext& context);

// What one optimiser steps together; `encoder` may be null. Borrows both.
std::vector<nn::ParameterSet*> CriticSets(nn::EncoderModule* encoder, nn::CriticModule* critic);

}  // namespace shoal::learner
