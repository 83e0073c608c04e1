// SPDX-License-Identifier: Apache-2.0
// The state of an agent in a checkpoint. Writing and reading use the same list of entries.
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

// Borrows the added objects, which must outlive the state. Only one thread may use an object.
class AgentState {
 public:
  // Adds parameters under their own names. Restore refreshes the module.
  void Add(nn::Module* module);
  // Adds parameters outside of any module (an average, a temperature): as PREFIX.NAME, or as NAME
  // if the prefix is empty.
  void Add(nn::ParameterSet* set, const std::string& prefix);
  // Adds an optimiser's moments and its counter of steps. `group`: part of the counter's name.
  void Add(nn::Adam* optimiser, const std::string& group);
  void Add(uint64_t* counter, const std::string& name);
  // Adds any other state by a function that writes it and a function that reads it. Like Restore,
  // `read` throws Error.
  using Write = std::function<void(nn::TensorMap*)>;
  using Read = std::function<void(const nn::TensorMap&, const std::string& source)>;
  void Add(Write write, Read read) { parts_.push_back({std::move(write), std::move(read)}); }

  nn::TensorMap Export() const;
  // Reads all entries. If a tensor is missing, has a wrong shape or belongs to no entry, throws
  // Error that names the tensor, and changes nothing.
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
