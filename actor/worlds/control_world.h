// SPDX-License-Identifier: Apache-2.0
// Base of the physics halves of the Control Suite's tasks: the order of engine calls in a reset and
// in a control step, and which of them run without actuation. Behaves as dm_control's rl/control.py
// and mujoco/engine.py ("legacy step") do.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "actor/worlds/world.h"

namespace shoal::worlds {

class ControlWorld : public World {
 public:
  // reset data; forward; Draw; Settle; forward. Both forwards run without actuation.
  void Reset(Random* random) final;
  // The same with a given state instead of a drawn one.
  void ResetTo(std::span<const double> qpos, std::span<const double> qvel);

  // Afterwards, values that depend on positions and velocities are current; those that depend on
  // accelerations (touch) are of the last engine step. Episodes never terminate.
  Outcome Step(std::span<const double> action) final;
  std::span<const CameraView> cameras() const final { return cameras_; }

 protected:
  struct Shape {
    int joints, actuators;
    int engine_steps;  // of a control step
  };
  // Throws Error when the model does not load or has another shape.
  ControlWorld(const std::string& model, const std::string& model_file, const Shape& shape);

  // Writes the initial state into data(), and what a task changes in the model.
  virtual void Draw(Random* random) = 0;
  // Lets the initial state come to rest, where a task does.
  virtual void Settle() {}
  virtual double Reward() const = 0;

  void ForwardWithoutActuation();
  void AdvanceControl(int engine_steps);
  // Redraws with `draw` until nothing touches. Throws Error after a thousand vain attempts.
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
