// SPDX-License-Identifier: Apache-2.0
// A user's environment behind a plain interface: arrays with the shapes and types of its
// description (common/tasks/environment_description.h), and actions in the environment's units.
// HostedEnvironment adapts a RawEnvironment to Environment. The Python package implements
// RawEnvironment for Gymnasium's interface; tests and user programs may implement RawEnvironment
// for other interfaces.
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
  // Starts an episode. Equal seeds start equal episodes if the environment supports seeds.
  virtual void Reset(uint32_t seed) = 0;
  // `action`: one number for each element of the description's action, within its bounds.
  virtual RawStep Step(std::span<const double> action) = 0;
  // The arrays of the newest observation in the description's order, each contiguous in C order.
  // Valid until the next Reset or Step.
  virtual std::span<const void* const> observation() const = 0;
  // Seconds that Reset and Step have spent converting arguments and results. The remaining time was
  // spent in the user's code.
  virtual double binding_seconds() const { return 0; }
  // Draws the present scene. Throws Error if the scene cannot be drawn.
  virtual RawPicture Render() = 0;
};

}  // namespace shoal::hosted
