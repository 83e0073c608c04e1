// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/encoder_and_head.h"

#include "common/nn/actor_critic_plan.h"

namespace shoal::learner {

std::unique_ptr<nn::EncoderModule> MakeEncoder(const NetworkConfig& network,
                                               const ObservationSpec& spec, nn::Module::Use use,
                                               const nn::ModuleContext& context,
                                               const std::string& name) {
  if (!spec.HasPixels()) return nullptr;
  return std::make_unique<nn::EncoderModule>(nn::PlanEncoder(network, spec, name), use, context);
}

std::vector<nn::ParameterSet*> SetsOf(nn::EncoderModule* encoder, nn::Module* head) {
  std::vector<nn::ParameterSet*> sets;
  if (encoder != nullptr) sets.push_back(&encoder->parameters());
  sets.push_back(&head->parameters());
  return sets;
}

}  // namespace shoal::learner
