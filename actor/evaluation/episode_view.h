// SPDX-License-Identifier: Apache-2.0
// A larger view, for people, of the episodes that a policy plays.
#pragma once

#include <cstdint>
#include <span>

namespace shoal::actor {

// One thread. Pictures are (H, W, 3) uint8, row 0 = top.
class EpisodeView {
 public:
  virtual ~EpisodeView() = default;
  virtual int height() const = 0;
  virtual int width() const = 0;
  // Duration of an env step in the world; 0 = unknown.
  virtual uint32_t step_microseconds() const = 0;
  // Draws the beginning of the episode of a stream key. The policy's environment has already begun
  // this episode. Throws Error if the picture cannot be drawn.
  virtual void Begin(uint64_t stream_key, std::span<uint8_t> picture) = 0;
  // Draws the scene after a step of the policy's environment with `action` (A). `reward`: of this
  // step.
  virtual void Step(std::span<const float> action, float reward, std::span<uint8_t> picture) = 0;
};

}  // namespace shoal::actor
