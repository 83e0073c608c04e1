// SPDX-License-Identifier: Apache-2.0
// The observations that an actor publishes and that a policy receives. `shoal-actor --describe`
// computes the spec once; config.json stores the spec. Every message contains the spec's hash, and
// every process compares this hash with the hash of its own spec.
//
// A record contains every block of the task. The policy's vector consists of the observed blocks,
// in the same order. The other blocks are used only in learning: as goals for hindsight, or as
// privileged inputs of a critic or a loss.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal {

// One named float32 vector of a record.
struct BlockSpec {
  std::string name;  // "grip", "observation", "achieved_goal", "desired_goal"
  int size = 0;
  bool observed = true;  // part of the policy's observation

  bool operator==(const BlockSpec&) const = default;
};

struct ObservationSpec {
  std::string task;                  // "FetchReachDense"
  std::vector<std::string> cameras;  // empty: no pixels
  int channels = 0;               // C of a frame: 3 per RGB camera, 1 per grey camera; 0: no pixels
  int height = 0, width = 0;      // H, W in pixels
  int stack = 1;                  // K frames per observation; the replay composes the stack
  std::vector<BlockSpec> blocks;  // in record order
  int action_size = 0;            // A, each in [-1, 1]
  // Whether a record also contains the drawn action before clipping to [-1, 1] and, in the header,
  // the log-probability of this action. On-policy learning needs the two values.
  bool drawn_actions = false;
  // Whether a picture of the episode's reached goal, (C, H, W) like a frame, follows the stack in
  // the policy's input (observation.goal_mode = image).
  bool goal_picture = false;
  // Description of a user's environment, as JSON (common/tasks/environment_description.h). The
  // process that runs the environment writes this text. Empty for one of Shoal's worlds.
  std::string environment;
  std::string model_fingerprint;  // hash of the compiled physics model and render settings, hex

  bool HasPixels() const { return channels > 0; }
  // One frame (C, H, W) uint8.
  int FrameBytes() const { return channels * height * width; }
  // I: channels of the policy's input (I, H, W): K*C for the stack and, with a goal picture, C
  // more.
  int InputChannels() const { return (stack + (goal_picture ? 1 : 0)) * channels; }
  int InputBytes() const { return InputChannels() * height * width; }
  // V: size of the policy's vector, which contains the observed blocks.
  int VectorSize() const;
  // R >= V: size of a record's vector, which contains all blocks.
  int RecordedVectorSize() const;

  // Floats first .. first + size - 1 of a vector.
  struct Range {
    int first = 0, size = 0;
    bool operator==(const Range&) const = default;
  };
  // The range of a block in a record's vector; empty for an unknown block.
  std::optional<Range> Recorded(std::string_view block) const;
  // The range of a block in the policy's vector; empty for an unknown block and for a block that is
  // not observed.
  std::optional<Range> Observed(std::string_view block) const;

  // Hash of the canonical JSON. Specs are compatible if and only if they are equal.
  uint64_t Hash() const;
  // Summary for messages: "FetchReachDense 2x84x84 RGB [front,side] stack 1, vector 0, action 4,
  // model 1a2b".
  std::string Summary() const;

  bool operator==(const ObservationSpec&) const = default;
};

nlohmann::json ToJson(const ObservationSpec& spec);
// Throws Error naming the missing or ill-typed key.
ObservationSpec ObservationSpecFromJson(const nlohmann::json& object);

// Copies selected blocks from a record's vector (R), in the record's order. A value type.
class BlockPicker {
 public:
  // Selects the observed blocks; the result is the policy's vector (V).
  static BlockPicker Observed(const ObservationSpec& spec);
  // Selects the blocks with these names. CHECKs that the spec has each block.
  static BlockPicker Named(const ObservationSpec& spec, std::span<const std::string> names);

  int size() const { return size_; }  // floats of the picked blocks
  // CHECKs that both sizes match. The memory must not overlap.
  void Copy(std::span<const float> recorded, std::span<float> picked) const;

 private:
  BlockPicker(const ObservationSpec& spec, const std::function<bool(const BlockSpec&)>& wanted);

  std::vector<ObservationSpec::Range> ranges_;  // in the record's vector; neighbours are merged
  int recorded_size_, size_ = 0;
};

}  // namespace shoal
