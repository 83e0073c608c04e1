// SPDX-License-Identifier: Apache-2.0
// Physics half of the Hopper tasks: a planar one-legged robot that is paid for moving forward.
//
// Behaviour of Gymnasium's Hopper-v4 and v5, and of the "custom hopper" pair used for sim-to-sim
// transfer, whose source lacks one kilogram of torso that its target has.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/world.h"

namespace shoal::worlds {

struct HopperVariant {
  // Masses and inertias that MuJoCo up to 2.1.0 gave capsules, instead of the exact ones.
  bool old_masses = false;
  // Added to the torso's mass (kg) after everything derived from it was computed.
  double torso_mass_change = 0;
  // Pay 1 for every step, also for the one that ends the episode.
  bool always_healthy_reward = false;
  // Velocities in the observation are limited to [-10, 10].
  bool clip_velocities = true;
};

class Hopper final : public World {
 public:
  static constexpr int kEngineStepsPerControlStep = 4;

  // `model_file` empty = our own model. Throws Error when it does not load, lacks an element or has
  // another number of joints.
  Hopper(const HopperVariant& variant, const std::string& model_file);

  // Positions, then velocities, each uniform within 0.005 of their rest.
  void Reset(Random* random) override;
  // Starts an episode from this state (6 each; m, rad and their rates).
  void ResetTo(std::span<const double> qpos, std::span<const double> qvel);

  // reward = forward velocity + 1 if healthy - 0.001 |action|^2; terminates when not healthy.
  Outcome Step(std::span<const double> action) override;
  // observation (11): positions without x, velocities; see the goal half. No goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;
  // track: follows the centre of mass, as published. free: does not.
  std::span<const CameraView> cameras() const override { return cameras_; }

 private:
  bool Healthy() const;

  HopperVariant variant_;
  std::vector<CameraView> cameras_;
};

std::unique_ptr<World> MakeHopperV4(const std::string& model_file);
std::unique_ptr<World> MakeHopperV5(const std::string& model_file);
std::unique_ptr<World> MakeCustomHopperSource(const std::string& model_file);
std::unique_ptr<World> MakeCustomHopperTarget(const std::string& model_file);

// The variants behind these names.
HopperVariant HopperV4();
HopperVariant HopperV5();
HopperVariant CustomHopperSource();
HopperVariant CustomHopperTarget();

}  // namespace shoal::worlds
