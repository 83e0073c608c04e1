// An Environment out of a task's two halves: the physics half moves, the goal half judges, the
// render context draws.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

class WorldEnvironment final : public Environment {
 public:
  // `task` outlives the environment. `render` null = no pixels, whatever `observation` says of
  // cameras. Throws Error (kUsage) on a camera or goal mode that does not exist.
  WorldEnvironment(const tasks::Task& task, std::unique_ptr<World> world,
                   const ObservationConfig& observation, std::shared_ptr<RenderContext> render);

  const ObservationSpec& spec() const override { return spec_; }
  float Reset(uint64_t stream_key, ObservationOut out) override;
  StepResult Step(std::span<const float> action, ObservationOut out) override;
  double render_seconds() const override { return render_seconds_; }

 private:
  // A block of the task: its numbers as records carry them, and whether observations do.
  struct Part {
    std::vector<double> exact;
    std::vector<float> numbers;
    bool published = false;
  };

  void BuildSpec(const ObservationConfig& observation);
  void Publish(Part* part, const tasks::Block& block);
  void ReadWorld();
  void Observe(ObservationOut out);
  float Distance() const;

  const tasks::Task& task_;
  std::unique_ptr<World> world_;
  std::shared_ptr<RenderContext> render_;
  std::vector<CameraView> cameras_;
  ObservationSpec spec_;
  Part observation_, achieved_goal_, desired_goal_;
  std::vector<double> action_;
  double render_seconds_ = 0;
  int episode_step_ = -1;  // env steps since the reset; -1 = never reset
};

}  // namespace shoal::worlds
