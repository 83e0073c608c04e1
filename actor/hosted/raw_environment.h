// SPDX-License-Identifier: Apache-2.0
// A user's environment behind a plain interface: arrays with the shapes and types of its
// description (common/tasks/environment_description.h), and actions in its own units.
// HostedEnvironment adapts a RawEnvironment to Environment. The Python package implements
// RawEnvironment for Gymnasium's interface; tests and user programs may implement it for others.
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
  std::optional<bool> success{};  // empty: the environment does not report success
};

// A picture for people: (H, W, 3) uint8, row 0 = top.
struct RawPicture {
  int height = 0, width = 0;
  std::vector<uint8_t> pixels;
};

// One thread. A failure in the user's code is thrown as an Error whose message names the call.
class RawEnvironment {
 public:
  virtual ~RawEnvironment() = default;
  // Starts an episode. Equal seeds start equal episodes if the environment supports it.
  virtual void Reset(uint32_t seed) = 0;
  // `action`: one number for each element of the description's action, within its bounds.
  virtual RawStep Step(std::span<const double> action) = 0;
  // The arrays of the newest observation in the description's order, each contiguous in C order.
  // Valid until the next Reset or Step.
  virtual std::span<const void* const> observation() const = 0;
  // Seconds within Reset and Step spent converting arguments and results. The remaining time is
  // the user's code.
  virtual double binding_seconds() const { return 0; }
  // Draws the present scene. Throws Error if it cannot be drawn.
  virtual RawPicture Render() = 0;
};

}  // namespace shoal::hosted
