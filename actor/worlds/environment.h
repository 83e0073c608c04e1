// One environment of a task, as the actor loop sees it: reset, step, observe. The physics half of a
// task lives behind it; only this folder knows MuJoCo.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::worlds {

// Where an observation is written: frame (C, H, W) u8, row 0 = top, empty without pixels; vector
// (V) f32, blocks in spec order. The caller owns the memory.
struct ObservationOut {
  std::span<uint8_t> frame;
  std::span<float> vector;
};

struct StepResult {
  float reward = 0;  // unscaled
  bool terminated = false, truncated = false, success = false;
  float distance = 0;  // of achieved to desired goal in m; NaN where the task has none
};

class Environment {
 public:
  virtual ~Environment() = default;
  virtual const ObservationSpec& spec() const = 0;
  // Starts the episode named by the stream key: equal keys give bit-identical episodes for equal
  // actions, whatever happened before. Returns the distance at the start.
  virtual float Reset(uint64_t stream_key, ObservationOut out) = 0;
  // `action` (A), each in [-1, 1].
  virtual StepResult Step(std::span<const float> action, ObservationOut out) = 0;
  // Seconds spent drawing frames since the construction.
  virtual double render_seconds() const = 0;
};

// Shares one off-screen render context between the environments of a process (one thread).
class RenderContext;
std::shared_ptr<RenderContext> MakeRenderContext(const ObservationConfig& observation);

// Throws Error: unknown task (listing those there are), unknown camera, model file that does not
// load. `render` may be null when config.observation.pixels is false.
std::unique_ptr<Environment> MakeEnvironment(const Config& config,
                                             std::shared_ptr<RenderContext> render);

}  // namespace shoal::worlds
