#include "actor/worlds/tools/replay_reference.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "actor/worlds/fetch_reach.h"
#include "actor/worlds/tools/reference_file.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

constexpr double kTolerance = 1e-5, kFoldingUpTolerance = 1e-3, kFoldingSidewaysTolerance = 1e-2;

double SequenceTolerance(const std::string& sequence) {
  if (sequence == "const_y") return kFoldingSidewaysTolerance;
  if (sequence == "const_z_close") return kFoldingUpTolerance;
  return kTolerance;
}

// Where joint values of the reference stand in our model.
struct JointOrder {
  std::vector<size_t> qpos, qvel;
};

JointOrder FindJoints(const FetchReach& world, const std::vector<std::string>& names) {
  JointOrder order;
  for (const std::string& name : names) {
    const int joint = world.JointId(name);
    order.qpos.push_back(static_cast<size_t>(world.model().jnt_qposadr[joint]));
    order.qvel.push_back(static_cast<size_t>(world.model().jnt_dofadr[joint]));
  }
  return order;
}

std::vector<double> Pick(const double* values, const std::vector<size_t>& order) {
  std::vector<double> picked;
  for (const size_t index : order) picked.push_back(values[index]);
  return picked;
}

// One replay: the world, and the report as it grows.
class Replay {
 public:
  Replay(const ReferenceTrajectory& reference, ReplayReport* report)
      : reference_(reference),
        report_(*report),
        world_(/*model_file=*/""),
        order_(FindJoints(world_, reference.joint_names)),
        sparse_(tasks::FindTask("FetchReach")),
        dense_(tasks::FindTask("FetchReachDense")),
        gripper_(world_.BodyId("robot0:gripper_link")) {}

  void Run() {
    const auto& initial_grip = world_.arm().initial_grip();
    Compare("initial_grip", "m", report_.tolerance, initial_grip, reference_.initial_grip, 0);
    world_.ResetTo(reference_.desired_goal);
    CompareState(reference_.reset, 0);
    int index = 0;
    for (const ReferenceStep& step : reference_.steps) {
      world_.Step(step.action);
      ++index;
      CompareState(step.state, index);
      CompareJudgement(step, index);
    }
  }

 private:
  void CompareState(const ReferenceState& expected, int step) {
    std::array<double, 10> observation{};
    std::array<double, 3> achieved{}, desired{};
    world_.Observe(observation, achieved, desired);
    const mjData& data = world_.data();
    const std::span<const double> ours(observation), theirs(expected.observation);
    Compare("grip_position", "m", report_.tolerance, ours.first(3), theirs.first(3), step);
    Compare("achieved_goal", "m", report_.tolerance, achieved, expected.achieved_goal, step);
    Compare("desired_goal", "m", report_.tolerance, desired, reference_.desired_goal, step);
    Compare("fingers", "m", report_.tolerance, ours.subspan(3, 2), theirs.subspan(3, 2), step);
    Compare("grip_velocity", "m/step", 0, ours.subspan(5, 3), theirs.subspan(5, 3), step);
    Compare("finger_velocity", "m/step", 0, ours.subspan(8, 2), theirs.subspan(8, 2), step);
    Compare("grip_quaternion", "", 0, std::span(data.xquat + 4 * gripper_, 4),
            expected.grip_quaternion, step);
    Compare("qpos", "", 0, Pick(data.qpos, order_.qpos), expected.qpos, step);
    Compare("qvel", "", 0, Pick(data.qvel, order_.qvel), expected.qvel, step);
    std::copy(achieved.begin(), achieved.end(), achieved_.begin());
    std::copy(desired.begin(), desired.end(), desired_.begin());
  }

  void CompareJudgement(const ReferenceStep& expected, int step) {
    const double distance = sparse_.Distance(achieved_, desired_);
    const double dense = dense_.Reward(distance);
    Compare("distance", "m", report_.tolerance, std::span(&distance, 1),
            std::span(&expected.distance, 1), step);
    Compare("reward_dense", "m", report_.tolerance, std::span(&dense, 1),
            std::span(&expected.reward_dense, 1), step);
    if (std::fabs(expected.distance - sparse_.distance_threshold()) <= report_.tolerance) return;
    if (sparse_.Reward(distance) != expected.reward_sparse) ++report_.reward_mismatches;
    if (sparse_.Success(distance) != expected.success) ++report_.success_mismatches;
  }

  void Compare(const char* quantity, const char* unit, double tolerance,
               std::span<const double> ours, std::span<const double> theirs, int step) {
    Deviation& deviation = Find(quantity, unit, tolerance);
    for (size_t i = 0; i < ours.size(); ++i) {
      const double difference = std::fabs(ours[i] - theirs[i]);
      if (difference <= deviation.largest) continue;
      deviation.largest = difference;
      deviation.at_step = step;
    }
  }

  Deviation& Find(const char* quantity, const char* unit, double tolerance) {
    for (Deviation& deviation : report_.deviations) {
      if (deviation.quantity == quantity) return deviation;
    }
    return report_.deviations.emplace_back(
        Deviation{.quantity = quantity, .unit = unit, .tolerance = tolerance});
  }

  const ReferenceTrajectory& reference_;
  ReplayReport& report_;
  FetchReach world_;
  JointOrder order_;
  const tasks::Task& sparse_;
  const tasks::Task& dense_;
  int gripper_;
  std::array<float, 3> achieved_{}, desired_{};
};

}  // namespace

ReplayReport ReplayReference(const std::filesystem::path& path) {
  const ReferenceTrajectory reference = ReadReference(path);
  ReplayReport report;
  report.file = path.string();
  report.environment = reference.environment;
  report.sequence = reference.sequence;
  report.steps = static_cast<int>(reference.steps.size());
  report.tolerance = SequenceTolerance(reference.sequence);
  Replay(reference, &report).Run();
  report.passed = report.reward_mismatches == 0 && report.success_mismatches == 0 &&
                  std::all_of(report.deviations.begin(), report.deviations.end(),
                              [](const Deviation& deviation) { return deviation.Passed(); });
  return report;
}

nlohmann::ordered_json ToJson(const ReplayReport& report) {
  nlohmann::ordered_json quantities = nlohmann::ordered_json::array();
  for (const Deviation& deviation : report.deviations) {
    nlohmann::ordered_json quantity{
        {"quantity", deviation.quantity}, {"unit", deviation.unit}, {"largest", deviation.largest},
        {"at_step", deviation.at_step},   {"tolerance", nullptr},   {"passed", deviation.Passed()}};
    if (deviation.tolerance > 0) quantity["tolerance"] = deviation.tolerance;
    quantities.push_back(quantity);
  }
  return {{"schema", "shoal-parity-1"},
          {"file", report.file},
          {"environment", report.environment},
          {"sequence", report.sequence},
          {"steps", report.steps},
          {"tolerance", report.tolerance},
          {"deviations", quantities},
          {"reward_mismatches", report.reward_mismatches},
          {"success_mismatches", report.success_mismatches},
          {"passed", report.passed}};
}

std::string ToText(const ReplayReport& report) {
  std::string text =
      fmt::format("{} {}, {} steps\n", report.environment, report.sequence, report.steps);
  for (const Deviation& deviation : report.deviations) {
    const std::string verdict =
        deviation.tolerance == 0
            ? ""
            : fmt::format("  {} {:.0e}", deviation.Passed() ? "within" : "BEYOND",
                          deviation.tolerance);
    text += fmt::format("  {:<16} {:9.2e} {:<6} at step {:<3}{}\n", deviation.quantity,
                        deviation.largest, deviation.unit, deviation.at_step, verdict);
  }
  text += fmt::format("  {} reward and {} success mismatches\n{}\n", report.reward_mismatches,
                      report.success_mismatches, report.passed ? "passed" : "FAILED");
  return text;
}

}  // namespace shoal::worlds
