// What an actor publishes and a network sees: computed once by `shoal-actor --describe`, stored in
// config.json, compared by hash by every process and carried by every message.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shoal {

// One named float32 vector of an observation.
struct BlockSpec {
  std::string name;  // "observation", "achieved_goal", "desired_goal"
  int size = 0;

  bool operator==(const BlockSpec&) const = default;
};

struct ObservationSpec {
  std::string task;                  // "FetchReachDense"
  std::vector<std::string> cameras;  // empty: no pixels
  int channels = 0;               // C of one frame: 3 per RGB camera, 1 per grey one; 0 = no pixels
  int height = 0, width = 0;      // H, W in pixels
  int stack = 1;                  // K frames per observation, composed when sampling
  std::vector<BlockSpec> blocks;  // vector part of an observation, in record order
  int action_size = 0;            // A, each in [-1, 1]
  std::string model_fingerprint;  // hash of the compiled physics model and render settings, hex

  bool HasPixels() const { return channels > 0; }
  // One frame (C, H, W) uint8.
  int FrameBytes() const { return channels * height * width; }
  // V: floats of all blocks together.
  int VectorSize() const;
  // Of the canonical JSON: equal specs and only they are compatible.
  uint64_t Hash() const;
  // "FetchReachDense 2x84x84 RGB [front,side] stack 1, vector 0, action 4, model 1a2b" for
  // messages.
  std::string Summary() const;

  bool operator==(const ObservationSpec&) const = default;
};

nlohmann::json ToJson(const ObservationSpec& spec);
// Throws Error naming the missing or ill-typed key.
ObservationSpec ObservationSpecFromJson(const nlohmann::json& object);

}  // namespace shoal
