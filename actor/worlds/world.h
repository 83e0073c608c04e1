// SPDX-License-Identifier: Apache-2.0
// The physics half of a task: a model, its state, and the effect of reset and step on both. Pixel
// layouts, rewards for goals and episode lengths belong to other classes.
//
// A step here is a control step; the environment repeats actions.
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
    double reward = 0;  // unscaled; used in tasks without goals
    bool terminated = false;
  };

  // Takes a newly loaded model. `model_file`: path of a user's model; empty = the built-in model.
  explicit World(ModelHandle model, const std::string& model_file = "");
  virtual ~World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Starts an episode. All random draws use `random`, in a fixed, documented order. The new state
  // does not depend on earlier episodes.
  virtual void Reset(Random* random) = 0;
  // `action`: the task's components, each in [-1, 1].
  virtual Outcome Step(std::span<const double> action) = 0;
  // Writes every number of the task's blocks; the goals are empty for tasks without goals. If a
  // number is not written, or if a number is written beyond a span, the program ends with a line
  // that names the block.
  virtual void Observe(std::span<double> observation, std::span<double> achieved_goal,
                       std::span<double> desired_goal) const = 0;
  // Hides the goal in all frames drawn from now on. Returns false if the goal cannot be hidden.
  virtual bool HideGoal() { return false; }
  // Cameras of the world; the first is the default camera. ModelCameras
  // (actor/worlds/model_cameras.h) returns the named cameras of the model. observation.cameras may
  // name a camera of the model even if cameras() does not list this camera. The span is valid as
  // long as the world.
  virtual std::span<const CameraView> cameras() const = 0;
  // Camera of the larger view of films; not part of cameras(). Null: films use a camera of
  // cameras(). Valid as long as the world.
  virtual const CameraView* film_camera() const { return nullptr; }
  // True if the task implements MoveToGoal, which pictures of goals need.
  virtual bool CanMoveToGoal() const { return false; }
  // Applies MoveToGoal to the state of the running episode, calls `look`, and then restores the
  // state bit for bit. CHECK: CanMoveToGoal().
  void LookAtGoal(const std::function<void()>& look);

  mjModel_& model() { return *model_; }
  const mjModel_& model() const { return *model_; }
  mjData_& data() { return *data_; }
  const mjData_& data() const { return *data_; }
  // Time of the engine's clock.
  double simulated_seconds() const;
  // Fingerprint of the loaded model before any change: see ModelFingerprint.
  const std::string& fingerprint() const { return fingerprint_; }

  // Frees the memory of the model's textures: 11 MB of sky for each world of the Control Suite.
  // Call ReleaseTextures for worlds that are never drawn, or whose render context already has the
  // model.
  void ReleaseTextures();
  bool textures_released() const { return textures_released_; }

  // Name of the model in messages: "the model" or "model file 'mine.xml'".
  const std::string& source() const { return source_; }

  // Ids of named elements. If the element is missing, the functions throw Error naming the model
  // and the element.
  int BodyId(const std::string& name) const;
  int SiteId(const std::string& name) const;
  int JointId(const std::string& name) const;
  int GeomId(const std::string& name) const;
  int SensorId(const std::string& name) const;

  // Clears the mark that the state has diverged, before a new episode.
  void ForgetDivergence();

  // Puts a site, such as a target's marker, at `position` (x, y, z in m, in the frame of the body
  // that carries the site). The next forward call moves the site. Writing site_pos alone is not
  // enough: if the model puts a site at its body's origin, the engine copies the body's position
  // and ignores site_pos.
  void PlaceSite(int site, std::span<const double> position);

 protected:
  // Sets the model's controls to the action, one number for each actuator. Throws Error (kUsage) if
  // the number of components is not the number of actuators.
  void SetControls(std::span<const double> action);
  // Makes `count` engine steps, then calls CheckState.
  void Advance(int count);
  // Throws EpisodeFault if the state has become non-finite or too large. The engine has then reset
  // the state without an error, so the episode must end.
  void CheckState() const;

 private:
  // Moves to a state in which the goal of the running episode is reached. Equal goals give equal
  // states. Each task defines and documents the rest of the state.
  virtual void MoveToGoal() {}
  int ElementId(int object_type, const char* kind, const std::string& name) const;

  ModelHandle model_;
  std::string source_;
  DataHandle data_;
  // Computed after the other members. The computation needs as much memory as the model; this
  // memory is then free for the next world.
  std::string fingerprint_;
  bool textures_released_ = false;
  DataHandle kept_data_;  // the episode's state during LookAtGoal; null before the first call
};

}  // namespace shoal::worlds
