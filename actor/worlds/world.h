// SPDX-License-Identifier: Apache-2.0
// The physics half of a task: a model, its state, and what reset and step do to them. Knows nothing
// of pixels' layout, rewards for goals or episode lengths.
//
// A step here is a control step; repeating actions is the environment's business.
//
// Numbers are the engine's doubles. One thread at a time per world; worlds are independent.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/engine_handles.h"
#include "common/base/random.h"

namespace shoal::worlds {

class World {
 public:
  // Result of a step besides the observation. Tasks with goals take the reward from their goal
  // half.
  struct Outcome {
    double reward = 0;  // of tasks without goals, unscaled
    bool terminated = false;
  };

  // Takes the model, as loaded; `model_file` is where a user's came from, empty = our own.
  explicit World(ModelHandle model, const std::string& model_file = "");
  virtual ~World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Starts an episode whose random draws come from `random` in a fixed, documented order. Nothing
  // of the episodes before remains.
  virtual void Reset(Random* random) = 0;
  // `action`: the task's components, each in [-1, 1].
  virtual Outcome Step(std::span<const double> action) = 0;
  // Writes every number of the task's blocks; goals are empty for tasks without goals. A write
  // beyond a span and an unwritten number end the program with a line that names the block.
  virtual void Observe(std::span<double> observation, std::span<double> achieved_goal,
                       std::span<double> desired_goal) const = 0;
  // Hides the goal in all frames drawn from now on. False: the goal cannot be hidden.
  virtual bool HideGoal() { return false; }
  // The first is the one to look at by default; ModelCameras (actor/worlds/model_cameras.h) gives
  // those that the model names. A camera of the model can be named in observation.cameras whether
  // it is listed here or not. Lives as long as the world.
  virtual std::span<const CameraView> cameras() const = 0;
  // For the larger view of films, none of cameras(); null where one of these serves. Lives as long
  // as the world.
  virtual const CameraView* film_camera() const { return nullptr; }
  // The task can show its goal reached: MoveToGoal, of which pictures of goals are drawn.
  virtual bool CanMoveToGoal() const { return false; }
  // Calls `look` with the world in the state that MoveToGoal makes of the running episode's, which
  // then is the episode's again, to the last bit. CHECK: CanMoveToGoal().
  void LookAtGoal(const std::function<void()>& look);

  mjModel_& model() { return *model_; }
  const mjModel_& model() const { return *model_; }
  mjData_& data() { return *data_; }
  const mjData_& data() const { return *data_; }
  // The engine's clock.
  double simulated_seconds() const;
  // Fingerprint of the model as loaded: see ModelFingerprint.
  const std::string& fingerprint() const { return fingerprint_; }

  // Gives the memory of the model's textures back to the system, 11 MB of sky for each world of the
  // Control Suite. For worlds that are drawn by a context that has a model already, or never.
  void ReleaseTextures();
  bool textures_released() const { return textures_released_; }

  // Name of the model in messages: "the model" or "model file 'mine.xml'".
  const std::string& source() const { return source_; }

  // Ids of named elements; throw Error naming the model and what it lacks.
  int BodyId(const std::string& name) const;
  int SiteId(const std::string& name) const;
  int JointId(const std::string& name) const;
  int GeomId(const std::string& name) const;
  int SensorId(const std::string& name) const;

  // Forgets that the state diverged: a new episode begins.
  void ForgetDivergence();

  // Puts a site, such as a target's marker, at `position` (x, y, z in m, in the frame of the body
  // that carries it). The next forward call moves it. Writing site_pos alone is not enough: of a
  // site that the model puts at its body's origin the engine copies the body's place and never
  // looks at site_pos.
  void PlaceSite(int site, std::span<const double> position);

 protected:
  // Sets the model's controls to the action, one number for each actuator. Throws Error (kUsage)
  // when the action has another number of components than the model has actuators.
  void SetControls(std::span<const double> action);
  // `count` engine steps, then CheckState.
  void Advance(int count);
  // Throws EpisodeFault when the state became non-finite or too large: the engine then resets
  // itself silently, so nothing after that can be trusted. The episode then ends.
  void CheckState() const;

 private:
  // Moves to a state in which the goal of the running episode is reached; the same state for the
  // same goal. Where the rest of the world is by then is the task's to say, and documented.
  virtual void MoveToGoal() {}
  int ElementId(int object_type, const char* kind, const std::string& name) const;

  ModelHandle model_;
  std::string source_;
  DataHandle data_;
  // Made last: what it takes as much memory as the model for is then free for the next world.
  std::string fingerprint_;
  bool textures_released_ = false;
  DataHandle kept_data_;  // the episode's, while LookAtGoal has the world moved; null before
};

}  // namespace shoal::worlds
