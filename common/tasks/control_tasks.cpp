// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/control_tasks.h"

#include <string>
#include <utility>

namespace shoal::tasks {
namespace {

constexpr int kEpisodeLength = 1000;

Task ControlTask(const std::string& name, int action_repeat, const std::string& reward,
                 std::vector<Component> action, std::vector<Component> observation) {
  Task::Description description;
  description.name = description.world = name;
  description.episode_length = kEpisodeLength;
  description.action_repeat = action_repeat;
  description.action = std::move(action);
  description.observation = {{"observation", std::move(observation)}};
  description.physics_reward = reward;
  return Task(std::move(description));
}

Component Motor(const std::string& name, const std::string& full) {
  return {name, "", "1 = " + full, -1, 1};
}

// Two numbers per body: cosine and sine of its lean.
Component Cosine(const std::string& body) {
  return {body + "_cosine", "", "cosine of the " + body + "'s lean, 1 = upright", -1, 1};
}
Component Sine(const std::string& body) {
  return {body + "_sine", "", "sine of the " + body + "'s lean", -1, 1};
}
Component Angle(const std::string& joint) { return {joint, "rad", "angle of joint " + joint}; }
Component AngularVelocity(const std::string& joint) {
  return {joint + "_velocity", "rad/s", "rate of joint " + joint};
}

Task CartpoleSwingup() {
  return ControlTask("cartpole_swingup", 8,
                     "upright * centered * small control * small velocity, each in [0, 1]",
                     {Motor("slide", "pushes the cart to the right with 10 N")},
                     {{"cart", "m", "position of the cart on its rail"},
                      Cosine("pole"),
                      Sine("pole"),
                      {"cart_velocity", "m/s", "velocity of the cart"},
                      AngularVelocity("pole")});
}

Task ReacherEasy() {
  return ControlTask("reacher_easy", 4, "1 while the finger overlaps the target, else 0",
                     {Motor("shoulder", "0.05 N m"), Motor("wrist", "0.05 N m")},
                     {Angle("shoulder"),
                      Angle("wrist"),
                      {"to_target_x", "m", "from the finger to the target, x"},
                      {"to_target_y", "m", "from the finger to the target, y"},
                      AngularVelocity("shoulder"),
                      AngularVelocity("wrist")});
}

Task CheetahRun() {
  const struct {
    const char *joint, *torque;
  } joints[] = {{"bthigh", "120 N m"}, {"bshin", "90 N m"}, {"bfoot", "60 N m"},
                {"fthigh", "90 N m"},  {"fshin", "60 N m"}, {"ffoot", "30 N m"}};
  std::vector<Component> action,
      observation{{"torso_z", "m", "height of the torso, 0 = as modelled"}, Angle("torso_pitch")};
  for (const auto& [joint, torque] : joints) {
    action.push_back(Motor(joint, torque));
    observation.push_back(Angle(joint));
  }
  observation.push_back({"torso_velocity_x", "m/s", "forward velocity of the torso"});
  observation.push_back({"torso_velocity_z", "m/s", "upward velocity of the torso"});
  observation.push_back(AngularVelocity("torso_pitch"));
  for (const auto& row : joints) observation.push_back(AngularVelocity(row.joint));
  return ControlTask("cheetah_run", 4, "forward speed / (10 m/s), within [0, 1]", std::move(action),
                     std::move(observation));
}

Task BallInCupCatch() {
  return ControlTask("ball_in_cup_catch", 4, "1 while the ball is inside the cup, else 0",
                     {Motor("cup_x", "pulls the cup to the right with 5 N"),
                      Motor("cup_z", "pulls the cup up with 5 N")},
                     {{"cup_x", "m", "cup to the right of its rest"},
                      {"cup_z", "m", "cup above its rest"},
                      {"ball_x", "m", "ball to the right of the cup's rest"},
                      {"ball_z", "m", "ball above a height of 0.2 m"},
                      {"cup_velocity_x", "m/s", "velocity of the cup to the right"},
                      {"cup_velocity_z", "m/s", "velocity of the cup upwards"},
                      {"ball_velocity_x", "m/s", "velocity of the ball to the right"},
                      {"ball_velocity_z", "m/s", "velocity of the ball upwards"}});
}

Task FingerSpin() {
  return ControlTask("finger_spin", 2, "1 while the spinner turns at -15 rad/s or faster, else 0",
                     {Motor("proximal", "30 N m"), Motor("distal", "15 N m")},
                     {Angle("proximal"),
                      Angle("distal"),
                      {"tip_x", "m", "from the spinner's axis to its tip, x"},
                      {"tip_z", "m", "from the spinner's axis to its tip, z"},
                      AngularVelocity("proximal"),
                      AngularVelocity("distal"),
                      AngularVelocity("spinner"),
                      {"touch_top", "", "ln(1 + force in N) on top of the fingertip"},
                      {"touch_bottom", "", "ln(1 + force in N) below the fingertip"}});
}

Task WalkerWalk() {
  const struct {
    const char *joint, *torque;
  } joints[] = {{"right_hip", "100 N m"}, {"right_knee", "50 N m"}, {"right_ankle", "20 N m"},
                {"left_hip", "100 N m"},  {"left_knee", "50 N m"},  {"left_ankle", "20 N m"}};
  std::vector<Component> action, observation;
  for (const char* body :
       {"torso", "right_thigh", "right_leg", "right_foot", "left_thigh", "left_leg", "left_foot"}) {
    observation.push_back(Cosine(body));
    observation.push_back(Sine(body));
  }
  observation.push_back({"torso_z", "m", "height of the torso"});
  observation.push_back({"torso_velocity_z", "m/s", "upward velocity of the torso"});
  observation.push_back({"torso_velocity_x", "m/s", "forward velocity of the torso"});
  observation.push_back(AngularVelocity("torso_pitch"));
  for (const auto& [joint, torque] : joints) {
    action.push_back(Motor(joint, torque));
    observation.push_back(AngularVelocity(joint));
  }
  return ControlTask("walker_walk", 2, "(3 standing + upright) / 4 * (5 walking + 1) / 6",
                     std::move(action), std::move(observation));
}

}  // namespace

std::vector<Task> ControlTasks() {
  return {CartpoleSwingup(), ReacherEasy(), CheetahRun(),
          BallInCupCatch(),  FingerSpin(),  WalkerWalk()};
}

}  // namespace shoal::tasks
