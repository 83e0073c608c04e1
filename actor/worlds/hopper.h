// SPDX-License-Identifier: Apache-2.0
// Physics half of the Hopper tasks: a planar one-legged robot, rewarded for moving forward.
//
// Follows Gymnasium's Hopper-v4 and v5, and the "custom hopper" pair for sim-to-sim transfer. The
// torso of the source is one kilogram lighter than the torso of the target.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/world.h"

namespace shoal::worlds {

struct HopperVariant {
  // Uses the masses and inertias that MuJoCo up to 2.1.0 gives capsules, instead of the exact
  // values.
  bool old_masses = false;
  // Added to the torso's mass (kg). Quantities derived from the mass are not recomputed.
  double torso_mass_change = 0;
  // Adds reward 1 for every step, also for the step that ends the episode.
  bool always_healthy_reward = false;
  // Limits velocities in the observation to [-10, 10].
  bool clip_velocities = true;
};

class Hopper final : public World {
 public:
  static constexpr int kEngineStepsPerControlStep = 4;

  // `model_file`: empty = the built-in model. Throws Error if the model does not load, lacks an
  // element or has another number of joints.
  Hopper(const HopperVariant& variant, const std::string& model_file);

  // Draws positions, then velocities, each uniform within 0.005 of the rest state.
  void Reset(Random* random) override;
  // Starts an episode from this state (6 each; m, rad and their rates).
  void ResetTo(std::span<const double> qpos, std::span<const double> qvel);

  // reward = forward velocity + 1 if healthy - 0.001 |action|^2; terminates when not healthy.
  Outcome Step(std::span<const double> action) override;
  // observation (11): positions without x, velocities; see the goal half. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;
  // track: follows the centre of mass, like the published camera. free: does not move.
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

// The variants of these tasks.
HopperVariant HopperV4();
HopperVariant HopperV5();
HopperVariant CustomHopperSource();
HopperVariant CustomHopperTarget();

}  // namespace shoal::worlds
