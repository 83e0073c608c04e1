// SPDX-License-Identifier: Apache-2.0
// The state of an agent in a checkpoint: one list from which it is written and read.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/nn/adam.h"
#include "common/nn/module.h"
#include "common/nn/safetensors.h"

namespace shoal::learner {

// Borrows what is added, which has to outlive it. One thread.
class AgentState {
 public:
  // Parameters under their own names; the module is refreshed when they were read.
  void Add(nn::Module* module);
  // Parameters of no module (an average, a temperature): as PREFIX.NAME, or as NAME without a
  // prefix.
  void Add(nn::ParameterSet* set, const std::string& prefix);
  // Moments and steps; `group` names the counter of steps.
  void Add(nn::Adam* optimiser, const std::string& group);
  void Add(uint64_t* counter, const std::string& name);
  // Anything else: what writes it, and what reads it back, throwing Error as Restore does.
  using Write = std::function<void(nn::TensorMap*)>;
  using Read = std::function<void(const nn::TensorMap&, const std::string& source)>;
  void Add(Write write, Read read) { parts_.push_back({std::move(write), std::move(read)}); }

  nn::TensorMap Export() const;
  // Throws Error naming a missing tensor or a wrong shape; then nothing has changed.
  void Restore(const nn::TensorMap& tensors, const std::string& source);

 private:
  void Import(const nn::TensorMap& tensors, const std::string& source);

  struct Part {
    Write write;
    Read read;
  };
  std::vector<Part> parts_;
};

}  // namespace shoal::learner
