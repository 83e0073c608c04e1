// SPDX-License-Identifier: Apache-2.0
// Base of the physics halves of the Control Suite's tasks. Defines the order of engine calls in a
// reset and in a control step, and the calls that run without actuation. Follows dm_control's
// rl/control.py and mujoco/engine.py ("legacy step").
#pragma once

#include <span>
#include <string>
#include <vector>

#include "actor/worlds/world.h"

namespace shoal::worlds {

class ControlWorld : public World {
 public:
  // Order of calls: reset data, forward, Draw, Settle, forward. Both forward calls run without
  // actuation.
  void Reset(Random* random) final;
  // Like Reset, with a given state instead of a drawn state.
  void ResetTo(std::span<const double> qpos, std::span<const double> qvel);

  // After a step, values that depend on positions and velocities are current. Values that depend on
  // accelerations (touch) belong to the last engine step. Episodes never terminate.
  Outcome Step(std::span<const double> action) final;
  std::span<const CameraView> cameras() const final { return cameras_; }

 protected:
  struct Shape {
    int joints, actuators;
    int engine_steps;  // per control step
  };
  // Throws Error if the model does not load or has another shape.
  ControlWorld(const std::string& model, const std::string& model_file, const Shape& shape);

  // Writes the initial state to data(). Also changes the model where the task requires it (for
  // example the target's position).
  virtual void Draw(Random* random) = 0;
  // Lets the initial state come to rest, if the task needs a state at rest.
  virtual void Settle() {}
  virtual double Reward() const = 0;

  void ForwardWithoutActuation();
  void AdvanceControl(int engine_steps);
  // Repeats `draw` until the state has no contacts. Throws Error after kMostDraws failed attempts.
  template <class DrawState>
  void DrawUntilFree(DrawState draw) {
    for (int attempt = 0; attempt < kMostDraws; ++attempt) {
      draw();
      ForwardWithoutActuation();
      if (NothingTouches()) return;
    }
    GiveUpDrawing();
  }

 private:
  static constexpr int kMostDraws = 1000;

  void Begin();
  void Finish();
  bool NothingTouches() const;
  [[noreturn]] void GiveUpDrawing() const;

  int engine_steps_;
  std::vector<CameraView> cameras_;
};

}  // namespace shoal::worlds
