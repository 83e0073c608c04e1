// SPDX-License-Identifier: Apache-2.0
// One environment of a task, as the actor loop sees it: reset, step, observe. It hides the physics
// half of the task; only this folder knows MuJoCo.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::worlds {

// Memory for one observation, owned by the caller. frame: (C, H, W) u8, row 0 = top, empty without
// pixels. vector: (R) f32, every block in spec order, observed or not.
struct ObservationOut {
  std::span<uint8_t> frame;
  std::span<float> vector;
};

// Result of one env step: of all its control steps (action_repeat) together.
struct StepResult {
  float reward = 0;  // unscaled, summed over the control steps
  bool terminated = false, truncated = false;
  bool success = false;  // after the last control step; false where the task has none
  float distance = 0;    // of achieved to desired goal in m; NaN where the task has none
};

// A body's mass, drawn for one episode.
struct DrawnMass {
  std::string body;
  double mass_kg = 0;
};

class Environment {
 public:
  virtual ~Environment() = default;
  virtual const ObservationSpec& spec() const = 0;
  // Reset and Step throw EpisodeFault (actor/worlds/episode_fault.h) when the simulation's state, a
  // number of an observation or a reward is not finite: the episode is over, that step has no
  // result, and `out` keeps its former content. They throw Error (kNonFinite) when an action is not
  // finite.
  //
  // Starts the episode named by the stream key: equal keys give bit-identical episodes for equal
  // actions, whatever happened before. Returns the distance at the start.
  virtual float Reset(uint64_t stream_key, ObservationOut out) = 0;
  // `action` (A), each in [-1, 1], is repeated for the control steps of an env step, or until the
  // episode ends; the observation is taken once, after the last.
  virtual StepResult Step(std::span<const float> action, ObservationOut out) = 0;
  // Simulated time since a moment before the last reset; always 0 if it is unknown.
  virtual double simulated_seconds() const { return 0; }
  // Seconds spent drawing frames since the construction.
  virtual double render_seconds() const = 0;
  // Seconds spent in a user's code since the construction; empty: all of the code is Shoal's.
  virtual std::optional<double> user_seconds() const { return std::nullopt; }
  // Drawn at the last reset, in the order drawn; empty unless the configuration randomizes.
  virtual std::span<const DrawnMass> drawn_masses() const = 0;
  // The goal of the running episode reached, drawn at its reset: (C, H, W) like a frame, from the
  // same cameras. Empty unless the spec has a goal picture.
  virtual std::span<const uint8_t> goal_picture() const { return {}; }
};

// Shares one off-screen render context between the environments of a process (one thread).
class RenderContext;
std::shared_ptr<RenderContext> MakeRenderContext(const ObservationConfig& observation);

// Throws Error: unknown task (listing those there are), unknown camera, model file that does not
// load. `render` may be null when config.observation.pixels is false.
std::unique_ptr<Environment> MakeEnvironment(const Config& config,
                                             std::shared_ptr<RenderContext> render);

}  // namespace shoal::worlds
