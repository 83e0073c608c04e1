// SPDX-License-Identifier: Apache-2.0
// An agent whose update is a hash of the batch: what was learned from is checkable, and costs
// little. Its policy is the one that a real agent begins with.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/base/sleep.h"
#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::simulation {

class HashAgent final : public learner::Agent {
 public:
  // `policy`: as nn::Policy loads them. An update takes `span` of simulated time.
  HashAgent(nn::TensorMap policy, std::chrono::microseconds span)
      : policy_(std::move(policy)), span_(span) {}

  learner::UpdateOutcome Update(const BatchView& batch,
                                const learner::OnStageEnd& on_stage_end) override {
    const uint64_t before = HashBytes(batch.data, batch.schema->total_bytes());
    SleepFor(span_);
    if (HashBytes(batch.data, batch.schema->total_bytes()) != before) {
      throw RuntimeError("the batch of update {} changed while it was read", updates_ + 1);
    }
    on_stage_end(learner::UpdateStage::kForward);
    hash_ = HashWords({hash_, before});
    ++updates_;
    learner::UpdateOutcome outcome;
    outcome.figures.Set(learner::kCriticLoss, 1.0 + static_cast<double>(hash_ % 1000) * 1e-3);
    return outcome;
  }

  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override { return policy_; }
  nn::TensorMap AveragedPolicyTensors() const override { return policy_; }

  nn::TensorMap AllTensors() const override {
    nn::TensorMap all = policy_;
    all["updates"] = Word(updates_);
    all["hash"] = Word(hash_);
    return all;
  }

  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    updates_ = WordOf(tensors, "updates", source);
    hash_ = WordOf(tensors, "hash", source);
  }

 private:
  static nn::NamedTensor Word(uint64_t value) {
    nn::NamedTensor tensor{.dtype = "U64", .shape = {1}, .data = std::vector<uint8_t>(8)};
    std::memcpy(tensor.data.data(), &value, sizeof value);
    return tensor;
  }
  static uint64_t WordOf(const nn::TensorMap& tensors, const std::string& name,
                         const std::string& source) {
    const auto found = tensors.find(name);
    if (found == tensors.end() || found->second.data.size() != sizeof(uint64_t)) {
      throw RuntimeError("'{}': no tensor {}", source, name);
    }
    uint64_t value = 0;
    std::memcpy(&value, found->second.data.data(), sizeof value);
    return value;
  }

  const nn::TensorMap policy_;
  const std::chrono::microseconds span_;
  uint64_t updates_ = 0, hash_ = 0;
};

}  // namespace shoal::simulation
