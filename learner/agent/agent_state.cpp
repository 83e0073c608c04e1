// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/agent_state.h"

#include "common/base/error.h"
#include "common/nn/tensor_words.h"

namespace shoal::learner {

void AgentState::Add(nn::Module* module) {
  nn::ParameterSet* set = &module->parameters();
  parts_.push_back({[set](nn::TensorMap* tensors) { set->Export(set->values(), "", tensors); },
                    [set, module](const nn::TensorMap& tensors, const std::string& source) {
                      set->Import(tensors, "", source, set->values());
                      module->Refresh();
                    }});
}

void AgentState::Add(nn::ParameterSet* set, const std::string& prefix) {
  const std::string before = prefix.empty() ? "" : prefix + ".";
  parts_.push_back(
      {[set, before](nn::TensorMap* tensors) { set->Export(set->values(), before, tensors); },
       [set, before](const nn::TensorMap& tensors, const std::string& source) {
         set->Import(tensors, before, source, set->values());
       }});
}

void AgentState::Add(nn::Adam* optimiser, const std::string& group) {
  parts_.push_back(
      {[optimiser, group](nn::TensorMap* tensors) { optimiser->Export(group, tensors); },
       [optimiser, group](const nn::TensorMap& tensors, const std::string& source) {
         optimiser->Import(tensors, group, source);
       }});
}

void AgentState::Add(uint64_t* counter, const std::string& name) {
  parts_.push_back(
      {[counter, name](nn::TensorMap* tensors) { nn::ExportCounter(name, *counter, tensors); },
       [counter, name](const nn::TensorMap& tensors, const std::string& source) {
         *counter = nn::ImportCounter(tensors, name, source);
       }});
}

nn::TensorMap AgentState::Export() const {
  nn::TensorMap tensors;
  for (const Part& part : parts_) part.write(&tensors);
  return tensors;
}

void AgentState::Import(const nn::TensorMap& tensors, const std::string& source) {
  for (const Part& part : parts_) part.read(tensors, source);
}

void AgentState::Restore(const nn::TensorMap& tensors, const std::string& source) {
  const nn::TensorMap former = Export();
  for (const auto& [name, tensor] : tensors) {
    if (!former.contains(name)) {
      throw RuntimeError("{}: tensor {}: this configuration has no such tensor", source, name);
    }
  }
  try {
    Import(tensors, source);
  } catch (const Error&) {
    Import(former, "former state");
    throw;
  }
}

}  // namespace shoal::learner
