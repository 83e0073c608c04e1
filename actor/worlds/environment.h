// SPDX-License-Identifier: Apache-2.0
// Interface of one environment of a task: reset, step, observe. The interface hides the physics
// half of the task; only this folder depends on MuJoCo.
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

// Result of one env step, over all its control steps (action_repeat).
struct StepResult {
  float reward = 0;  // unscaled, summed over the control steps
  bool terminated = false, truncated = false;
  bool success = false;  // after the last control step; false for tasks without success
  float distance = 0;    // of achieved to desired goal in m; NaN for tasks without goals
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
  // Reset and Step throw EpisodeFault (actor/worlds/episode_fault.h) if the simulation's state, a
  // number of an observation or a reward is not finite. The episode is then over, the step has no
  // result, and `out` is unchanged. Step throws Error (kNonFinite) if an action is not finite.
  //
  // Starts the episode of the stream key. Equal keys and equal actions give bit-identical episodes,
  // independent of earlier episodes. Returns the distance at the start.
  virtual float Reset(uint64_t stream_key, ObservationOut out) = 0;
  // Plays one env step: repeats `action` (A), each component in [-1, 1], for all control steps of
  // the env step or until the episode ends. Observes once, after the last control step.
  virtual StepResult Step(std::span<const float> action, ObservationOut out) = 0;
  // Simulated time since a fixed moment before the last reset; always 0 if unknown.
  virtual double simulated_seconds() const { return 0; }
  // Seconds spent drawing frames since construction.
  virtual double render_seconds() const = 0;
  // Seconds spent in a user's code since construction; empty if the environment has no user code.
  virtual std::optional<double> user_seconds() const { return std::nullopt; }
  // Masses drawn at the last reset, in drawing order; empty unless the configuration randomizes
  // masses.
  virtual std::span<const DrawnMass> drawn_masses() const = 0;
  // Goal picture of the running episode: shows the goal reached. The picture is drawn at the reset
  // by the cameras of the frames, (C, H, W) like a frame. Empty unless the spec has a goal picture.
  virtual std::span<const uint8_t> goal_picture() const { return {}; }
};

// Shares one off-screen render context between the environments of a process (one thread).
class RenderContext;
std::shared_ptr<RenderContext> MakeRenderContext(const ObservationConfig& observation);

// Makes the environment of a configuration. Throws Error on an unknown task (the message lists the
// known tasks), an unknown camera, or a model file that does not load. `render` may be null if
// config.observation.pixels is false.
std::unique_ptr<Environment> MakeEnvironment(const Config& config,
                                             std::shared_ptr<RenderContext> render);

}  // namespace shoal::worlds
