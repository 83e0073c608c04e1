// SPDX-License-Identifier: Apache-2.0
// Acts by a checkpoint's policy, without exploration: the action of a batch of observations is what
// an evaluation actor would play.
//
// Dimensions: N observations of a batch, K frames of a stack, C channels of a frame (all cameras),
// I = K*C, or (K+1)*C with a goal picture, H, W, A actions. Arrays are row-major.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "common/nn/policy.h"
#include "common/nn/precision.h"
#include "common/policy/checkpoint_policy.h"

namespace shoal::policy {

// A named block of observations, (N, size of the block).
struct ObservedBlock {
  std::string_view name;
  std::span<const float> values;
};

// N observations, borrowed for a call.
struct Observations {
  int count = 0;  // N
  // (N, I, H, W), row 0 = top; of a stack the oldest frame first, at an episode's start the first
  // frame K times; a goal picture comes last. Unread by a policy without pixels.
  std::span<const uint8_t> pixels = {};
  // Each block that the policy observes, in any order, and no other.
  std::span<const ObservedBlock> blocks = {};
};

// One thread at a time; objects are independent of each other. Computes on the calling thread.
class TrainedPolicy {
 public:
  // Parameters that do not fit the description are refused with Error. Builds the network for one
  // observation; those for batches are built when they are first asked for.
  explicit TrainedPolicy(const CheckpointPolicy& policy,
                         nn::Precision precision = nn::Precision::kF32);
  // Reads and throws as ReadCheckpointPolicy.
  explicit TrainedPolicy(const std::filesystem::path& checkpoint,
                         nn::Precision precision = nn::Precision::kF32);

  const PolicyDescription& description() const { return description_; }
  const ObservationSpec& spec() const { return description_.spec; }

  // Writes actions (N, A), each in [-1, 1]. An action is the same to f32's last digits whatever N.
  // Throws Error in one line: kUsage naming an array of another size than expected, a block that is
  // missing, unknown or given twice; kNonFinite naming a block with a number that is not finite,
  // or where the policy's output is not.
  void Act(const Observations& observations, std::span<float> actions);

 private:
  void CheckPixels(const Observations& observations) const;
  void GatherVectors(const Observations& observations);

  const PolicyDescription description_;
  nn::Policy policy_;
  std::vector<float> vectors_;  // (N, V)
};

}  // namespace shoal::policy
