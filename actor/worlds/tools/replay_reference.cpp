// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/replay_reference.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "actor/worlds/fetch_object_world.h"
#include "actor/worlds/world_registry.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

constexpr double kTolerance = 1e-5, kFoldingUpTolerance = 1e-3, kFoldingSidewaysTolerance = 1e-2;
constexpr double kHitSpeed = 0.01;  // m/s

double SequenceTolerance(const std::string& sequence) {
  if (sequence == "const_y") return kFoldingSidewaysTolerance;
  if (sequence == "const_z_close") return kFoldingUpTolerance;
  return kTolerance;
}

// Indices of the reference's joints in Shoal's model. A free joint has all of its numbers.
struct JointOrder {
  std::vector<size_t> qpos, qvel;
};

JointOrder FindJoints(const World& world, const std::vector<std::string>& names) {
  JointOrder order;
  for (const std::string& name : names) {
    const int joint = world.JointId(name);
    const bool free = world.model().jnt_type[joint] == mjJNT_FREE;
    for (int i = 0; i < (free ? 7 : 1); ++i) {
      order.qpos.push_back(static_cast<size_t>(world.model().jnt_qposadr[joint] + i));
    }
    for (int i = 0; i < (free ? 6 : 1); ++i) {
      order.qvel.push_back(static_cast<size_t>(world.model().jnt_dofadr[joint] + i));
    }
  }
  return order;
}

std::vector<double> Pick(const double* values, const std::vector<size_t>& order) {
  std::vector<double> picked;
  picked.reserve(order.size());
  for (const size_t index : order) picked.push_back(values[index]);
  return picked;
}

// A range of the observation's numbers.
struct Part {
  const char* quantity;
  const char* unit;
  size_t first, count;
  bool judged, of_object;
};
constexpr Part kReachParts[] = {{"grip_position", "m", 0, 3, true, false},
                                {"fingers", "m", 3, 2, true, false},
                                {"grip_velocity", "m/step", 5, 3, false, false},
                                {"finger_velocity", "m/step", 8, 2, false, false}};
constexpr Part kObjectParts[] = {{"grip_position", "m", 0, 3, true, false},
                                 {"object_position", "m", 3, 3, true, true},
                                 {"object_from_grip", "m", 6, 3, true, true},
                                 {"fingers", "m", 9, 2, true, false},
                                 {"object_angle", "rad", 11, 3, false, true},
                                 {"object_velocity", "m/step", 14, 3, false, true},
                                 {"object_angular_velocity", "rad/step", 17, 3, false, true},
                                 {"grip_velocity", "m/step", 20, 3, false, false},
                                 {"finger_velocity", "m/step", 23, 2, false, false}};

// One replay: the world and the report so far.
class Replay {
 public:
  Replay(const ReferenceTrajectory& reference, FetchWorld* world, ReplayReport* report)
      : reference_(reference),
        report_(*report),
        world_(*world),
        order_(FindJoints(world_, reference.joint_names)),
        sparse_(tasks::FindTask(reference.task)),
        dense_(tasks::FindTask(reference.task + "Dense")),
        gripper_(world_.BodyId("robot0:gripper_link")),
        observation_(static_cast<size_t>(sparse_.observation().size())) {}

  void Run() {
    Compare("initial_grip", "m", true, world_.arm().initial_grip(), reference_.initial_grip, 0);
    if (reference_.has_object) {
      const double height = dynamic_cast<const FetchObjectWorld&>(world_).table_height();
      Compare("table_height", "m", true, std::span(&height, 1),
              std::span(&reference_.table_height, 1), 0);
    }
    world_.ResetTo(reference_.desired_goal, reference_.object_xy);
    CompareState(reference_.reset, 0);
    int index = 0;
    for (const ReferenceStep& step : reference_.steps) {
      world_.Step(step.action);
      ++index;
      CompareState(step.state, index);
      if (!Chaotic(index)) CompareJudgement(step, index);
    }
  }

 private:
  bool Chaotic(int step) const { return report_.chaotic_from > 0 && step >= report_.chaotic_from; }

  void CompareState(const ReferenceState& expected, int step) {
    world_.Observe(observation_, achieved_, desired_);
    const std::span<const double> ours(observation_), theirs(expected.observation);
    const std::span<const Part> parts =
        reference_.has_object ? std::span<const Part>(kObjectParts) : kReachParts;
    for (const Part& part : parts) {
      const bool chaotic = part.of_object && Chaotic(step);
      Compare(part.quantity + std::string(chaotic ? "_once_hit" : ""), part.unit,
              part.judged && !chaotic, ours.subspan(part.first, part.count),
              theirs.subspan(part.first, part.count), step);
    }
    if (!Chaotic(step) || !reference_.has_object) {
      Compare("achieved_goal", "m", true, achieved_, expected.achieved_goal, step);
    }
    Compare("desired_goal", "m", true, desired_, reference_.desired_goal, step);
    const mjData& data = world_.data();
    Compare("grip_quaternion", "", false, std::span(data.xquat + 4 * gripper_, 4),
            expected.grip_quaternion, step);
    Compare("qpos", "", false, Pick(data.qpos, order_.qpos), expected.qpos, step);
    Compare("qvel", "", false, Pick(data.qvel, order_.qvel), expected.qvel, step);
    if (data.ncon != expected.contacts) ++report_.contact_mismatches;
  }

  void CompareJudgement(const ReferenceStep& expected, int step) {
    double sum = 0;
    std::array<float, 3> achieved{}, desired{};
    for (size_t i = 0; i < 3; ++i) {
      sum += (achieved_[i] - desired_[i]) * (achieved_[i] - desired_[i]);
      achieved[i] = static_cast<float>(achieved_[i]);
      desired[i] = static_cast<float>(desired_[i]);
    }
    const double exact = std::sqrt(sum);
    Compare("distance", "m", true, std::span(&exact, 1), std::span(&expected.distance, 1), step);
    // Rewards come from the goal half, for goals rounded to float32 as in records.
    const double distance = sparse_.Distance(achieved, desired);
    const double dense = dense_.Reward(distance);
    Compare("reward_dense", "m", true, std::span(&dense, 1), std::span(&expected.reward_dense, 1),
            step);
    if (std::fabs(expected.distance - sparse_.distance_threshold()) <= report_.tolerance) return;
    if (sparse_.Reward(distance) != expected.reward_sparse) ++report_.reward_mismatches;
    if (sparse_.Success(distance) != expected.success) ++report_.success_mismatches;
  }

  void Compare(const std::string& quantity, const char* unit, bool judged,
               std::span<const double> ours, std::span<const double> theirs, int step) {
    report_.Compare(quantity, unit, judged ? report_.tolerance : 0, ours, theirs, step);
  }

  const ReferenceTrajectory& reference_;
  ReplayReport& report_;
  FetchWorld& world_;
  JointOrder order_;
  const tasks::Task sparse_;
  const tasks::Task dense_;
  int gripper_;
  std::vector<double> observation_;
  std::array<double, 3> achieved_{}, desired_{};
};

}  // namespace

int FirstHit(const ReferenceTrajectory& reference) {
  if (reference.task != "FetchSlide") return 0;
  for (size_t i = 0; i < reference.steps.size(); ++i) {
    const std::vector<double>& qvel = reference.steps[i].state.qvel;
    // The puck has the last joint: three linear velocities, three angular ones.
    const double* linear = qvel.data() + qvel.size() - 6;
    if (std::hypot(linear[0], linear[1], linear[2]) > kHitSpeed) return static_cast<int>(i) + 1;
  }
  return 0;
}

ReplayReport ReplayReference(const std::filesystem::path& path, const ReplayOptions& options) {
  const ReferenceTrajectory reference = ReadReference(path);
  ReplayReport report;
  report.file = path.string();
  report.environment = reference.environment;
  report.sequence = reference.sequence;
  report.physics = options.physics.empty() ? "mujoco2" : options.physics;
  report.model = options.model;
  report.steps = static_cast<int>(reference.steps.size());
  report.tolerance = SequenceTolerance(reference.sequence);
  report.chaotic_from = FirstHit(reference);
  const std::unique_ptr<World> world = MakeWorld(reference.task, {options.model, report.physics});
  Replay(reference, &dynamic_cast<FetchWorld&>(*world), &report).Run();
  report.Judge();
  return report;
}

}  // namespace shoal::worlds
