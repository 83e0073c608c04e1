// SPDX-License-Identifier: Apache-2.0
// Acts by a checkpoint's policy, without exploration: computes the actions that an evaluation actor
// would take for a batch of observations.
//
// Dimensions: N observations of a batch, K frames of a stack, C channels of a frame (all cameras),
// (H, W) height and width of a frame, I input channels (K*C, or (K+1)*C with a goal picture), V
// numbers of the observed blocks, A actions. Arrays are row-major.
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
  // (N, I, H, W), row 0 = top. The frames of a stack are ordered, oldest first; at an episode's
  // start, the first frame is repeated K times. A goal picture follows the stack. A policy without
  // pixels ignores this member.
  std::span<const uint8_t> pixels = {};
  // All blocks that the policy observes, in any order, and no other blocks.
  std::span<const ObservedBlock> blocks = {};
};

// Only one thread at a time may use an object; objects are independent of each other. All
// computation is on the calling thread.
class TrainedPolicy {
 public:
  // Builds the network for one observation. Networks for batches are built at their first use.
  // Throws Error if the parameters do not fit the description.
  explicit TrainedPolicy(const CheckpointPolicy& policy,
                         nn::Precision precision = nn::Precision::kF32);
  // Reads the checkpoint as ReadCheckpointPolicy does, and throws the same errors.
  explicit TrainedPolicy(const std::filesystem::path& checkpoint,
                         nn::Precision precision = nn::Precision::kF32);

  const PolicyDescription& description() const { return description_; }
  const ObservationSpec& spec() const { return description_.spec; }

  // Writes actions (N, A), each in [-1, 1]. The other observations of the batch can change an
  // action only in the last digits of f32. Throws Error in one line. kUsage: an array has the wrong
  // size, or a block is missing, unknown or given twice. kNonFinite: a block or the policy's output
  // has a number that is not finite.
  void Act(const Observations& observations, std::span<float> actions);

 private:
  void CheckPixels(const Observations& observations) const;
  void GatherVectors(const Observations& observations);

  const PolicyDescription description_;
  nn::Policy policy_;
  std::vector<float> vectors_;  // (N, V)
};

}  // namespace shoal::policy
