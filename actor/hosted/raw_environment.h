// SPDX-License-Identifier: Apache-2.0
// An environment as its own interface has it: arrays of the shapes and types that its description
// names (common/tasks/environment_description.h), actions in its own units. HostedEnvironment makes
// one of Shoal's environments of it. The Python package implements it for Gymnasium's interface;
// a test or a program of a user's may implement it for another.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shoal::hosted {

// The results of a step besides the observation.
struct RawStep {
  double reward = 0;
  bool terminated = false, truncated = false;
  std::optional<bool> success{};  // empty: the step does not say
};

// A picture for people: (H, W, 3) uint8, row 0 = top.
struct RawPicture {
  int height = 0, width = 0;
  std::vector<uint8_t> pixels;
};

// One thread. Whatever goes wrong in the user's code is an Error whose message names the call.
class RawEnvironment {
 public:
  virtual ~RawEnvironment() = default;
  // Starts an episode; equal seeds start equal episodes where the environment allows it.
  virtual void Reset(uint32_t seed) = 0;
  // `action`: one number for each element of the description's action, within its bounds.
  virtual RawStep Step(std::span<const double> action) = 0;
  // The arrays of the newest observation in the description's order, each contiguous in C order.
  // Valid until the next Reset or Step.
  virtual std::span<const void* const> observation() const = 0;
  // Seconds of Reset and Step that converted arguments and results; the rest is the user's code.
  virtual double binding_seconds() const { return 0; }
  // Draws the present scene. Throws Error if it cannot be drawn.
  virtual RawPicture Render() = 0;
};

}  // namespace shoal::hosted
