// SPDX-License-Identifier: Apache-2.0
// Environment made of a task's two halves and a render context. The physics half simulates, the
// goal half computes rewards and success, the render context draws.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/mass_randomization.h"
#include "actor/worlds/observed_numbers.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

class WorldEnvironment final : public Environment {
 public:
  // `render`: null = no pixels, even if the configuration has cameras. ChooseCameras
  // (actor/worlds/custom_cameras.h) selects the cameras. The environment uses these parts of
  // `config`: observation, randomization, action_repeat, end_on_success, and whether hindsight is
  // on. Throws Error (kUsage) if a camera, goal mode or body does not exist, or if end_on_success
  // is set for a task without success.
  WorldEnvironment(const tasks::Task& task, std::unique_ptr<World> world, const Config& config,
                   std::shared_ptr<RenderContext> render);

  const ObservationSpec& spec() const override { return spec_; }
  float Reset(uint64_t stream_key, ObservationOut out) override;
  StepResult Step(std::span<const float> action, ObservationOut out) override;
  double simulated_seconds() const override { return world_->simulated_seconds(); }
  double render_seconds() const override { return render_seconds_; }
  std::span<const DrawnMass> drawn_masses() const override { return masses_.drawn(); }
  std::span<const uint8_t> goal_picture() const override { return goal_picture_; }

 private:
  // Hides the goal in the pictures. Pictures must not show the desired goal if hindsight replaces
  // goals, or if a separate goal picture shows the goal.
  void HideGoal(const char* why);
  void PrepareGoalPicture();
  void BuildSpec(const ObservationConfig& observation);
  void AddStateBlocks(const ObservationConfig& observation);
  void AddGoal(const tasks::Block& block, bool observed);
  void CheckAction(std::span<const float> action);
  void StepWorld(StepResult* result);
  void ReadWorld();
  void Round(std::span<const tasks::Block> blocks, std::span<const double> exact,
             std::vector<float>* rounded) const;
  void Observe(ObservationOut out);
  void Draw(std::span<uint8_t> frame);
  // Distance of the achieved to the desired goal; NaN for tasks without goals.
  double Distance() const;

  const tasks::Task task_;
  const int action_repeat_;
  const bool end_on_success_;
  std::unique_ptr<World> world_;
  MassRandomization masses_;
  std::shared_ptr<RenderContext> render_;
  std::vector<CameraView> cameras_;
  bool goal_hidden_ = false;
  ObservationSpec spec_;
  std::vector<uint8_t> goal_picture_;  // (C, H, W); empty if the spec has no goal picture
  ObservedNumbers observed_;  // the world's numbers, float64; the next members hold them as float32
  std::vector<float> state_, achieved_goal_, desired_goal_;
  std::vector<double> action_;
  double render_seconds_ = 0;
  int control_step_ = -1;  // since the reset; -1 = never reset
};

}  // namespace shoal::worlds
