// SPDX-License-Identifier: Apache-2.0
// A cheap agent whose update is a hash of the batch. The policy's first action encodes the number
// of updates, so that tests can compare an evaluated policy with the name of its checkpoint. The
// agent reports a broken promise if a batch changes while the agent reads the batch, or if
// observations are not consecutive (fake_environment.h).
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/base/sleep.h"
#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"
#include "tests/simulation/story.h"

namespace shoal::simulation {

class HashAgent final : public learner::Agent {
 public:
  // `policy`: tensors in the form that nn::Policy loads. `span`: simulated time of an update.
  HashAgent(nn::TensorMap policy, std::chrono::microseconds span, Story& story)
      : policy_(std::move(policy)), span_(span), story_(story) {
    for (auto& [name, tensor] : policy_) std::ranges::fill(tensor.data, 0);
  }

  // The first action of the policy after this number of updates, without exploration.
  static double ActionAfter(uint64_t updates) { return static_cast<double>(updates) / 10'000; }

  std::vector<learner::UpdateOutcome> Submit(const BatchView& batch,
                                             const learner::OnStageEnd& on_stage_end) override {
    CheckFollows(batch);
    const uint64_t before = HashBytes(batch.data, batch.schema->total_bytes());
    SleepFor(span_);
    if (HashBytes(batch.data, batch.schema->total_bytes()) != before) {
      story_.Violate(fmt::format("the batch of update {} changed while it was read", updates_ + 1));
    }
    on_stage_end(learner::UpdateStage::kForward);
    hash_ = HashWords({hash_, before});
    ++updates_;
    learner::UpdateOutcome outcome;
    for (const float probability : batch.probability) {
      if (!(probability > 0 && probability <= 1)) {
        story_.Violate(fmt::format("update {}: a sample of probability {}", updates_, probability));
      }
      outcome.errors.push_back(static_cast<float>(HashWords({hash_, outcome.errors.size()}) % 5));
    }
    outcome.figures.Set(learner::kCriticLoss, 1.0 + static_cast<double>(hash_ % 1000) * 1e-3);
    return {outcome};
  }

  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override {
    nn::TensorMap policy = policy_;
    const bool squashed = !policy.contains("actor.log_std");
    const double action = ActionAfter(updates_);
    const float mean = static_cast<float>(squashed ? std::atanh(action) : action);
    std::memcpy(policy.at("actor.mlp.output.bias").data.data(), &mean, sizeof mean);
    return policy;
  }
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }

  nn::TensorMap AllTensors() const override {
    nn::TensorMap all;
    all["updates"] = Word(updates_);
    all["hash"] = Word(hash_);
    return all;
  }

  void Restore(const nn::TensorMap& tensors, const std::string& source) override {
    updates_ = WordOf(tensors, "updates", source);
    hash_ = WordOf(tensors, "hash", source);
  }

 private:
  // Checks that each next observation is the successor of its observation.
  void CheckFollows(const BatchView& batch) const {
    const size_t rows = batch.rows(), size = batch.obs_vector.size() / rows;
    const bool rollout = !batch.continues.empty();
    for (size_t row = 0; row < rows; ++row) {
      const float* observation = &batch.obs_vector[row * size];
      const bool next_row = rollout && batch.continues[row] != 0;
      const float* next =
          next_row ? &batch.obs_vector[(row + 1) * size] : &batch.next_obs_vector[row * size];
      const bool ends = rollout && batch.ends[row] != 0;
      if (next_row && ends) continue;  // the next row begins an episode
      if (next[0] == observation[0] && next[1] == observation[1] + 1) continue;
      story_.Violate(fmt::format("update {}, row {}: step {} of episode {} is followed by {} of {}",
                                 updates_ + 1, row, observation[1], observation[0], next[1],
                                 next[0]));
      return;
    }
  }

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

  nn::TensorMap policy_;  // all values are zero
  const std::chrono::microseconds span_;
  Story& story_;
  uint64_t updates_ = 0, hash_ = 0;
};

}  // namespace shoal::simulation
