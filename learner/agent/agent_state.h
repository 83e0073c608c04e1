// SPDX-License-Identifier: Apache-2.0
// The state of an agent in a checkpoint. One list of entries defines both writing and reading.
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

// Borrows the added objects, which must outlive the state. One thread.
class AgentState {
 public:
  // Adds parameters under their own names. Restore refreshes the module.
  void Add(nn::Module* module);
  // Adds parameters outside of any module (an average, a temperature): as PREFIX.NAME, or as NAME
  // if the prefix is empty.
  void Add(nn::ParameterSet* set, const std::string& prefix);
  // Adds an optimiser's moments and its counter of steps, which `group` names.
  void Add(nn::Adam* optimiser, const std::string& group);
  void Add(uint64_t* counter, const std::string& name);
  // Adds any other state by a function that writes it and a function that reads it. Like Restore,
  // `read` throws Error.
  using Write = std::function<void(nn::TensorMap*)>;
  using Read = std::function<void(const nn::TensorMap&, const std::string& source)>;
  void Add(Write write, Read read) { parts_.push_back({std::move(write), std::move(read)}); }

  nn::TensorMap Export() const;
  // Throws Error that names a missing tensor or a wrong shape, and then changes nothing.
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
