// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/replay_states.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>
#include <memory>

#include "actor/worlds/control_world.h"
#include "actor/worlds/hopper.h"
#include "actor/worlds/reacher_easy.h"
#include "actor/worlds/world_registry.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "tests/actor/worlds/parity/state_reference.h"

namespace shoal::worlds {
namespace {

constexpr double kHopperTolerance = 1e-9, kHopperLandingTolerance = 1e-4;
constexpr double kControlTolerance = 1e-9;
constexpr double kLargestVelocityRecorded = 10;
constexpr size_t kHopperPositions = 5;  // of an observation; velocities follow

HopperVariant FindVariant(const StateTrajectory& reference, const std::filesystem::path& path) {
  HopperVariant gymnasium_source = HopperV5();
  gymnasium_source.torso_mass_change = -1;
  const std::map<std::string, HopperVariant> variants{{"gymnasium", HopperV5()},
                                                      {"gymnasium_source", gymnasium_source},
                                                      {"custom_target", CustomHopperTarget()},
                                                      {"custom_source", CustomHopperSource()}};
  const auto found = variants.find(reference.variant);
  if (found != variants.end()) return found->second;
  std::string names;
  for (const auto& [name, variant] : variants) names += (names.empty() ? "" : ", ") + name;
  throw RuntimeError("reference file '{}': key 'variant' is '{}'; expected one of {}",
                     path.string(), reference.variant, names);
}

// The world a trajectory is replayed in, at its start.
std::unique_ptr<World> StartHopper(const StateTrajectory& reference,
                                   const std::filesystem::path& path, const WorldOptions& options) {
  MakeWorld("Hopper-v5", options);  // refuses what does not fit any hopper
  auto world = std::make_unique<Hopper>(FindVariant(reference, path), options.model);
  world->ResetTo(reference.drawn_qpos, reference.drawn_qvel);
  return world;
}

std::unique_ptr<World> StartControl(const StateTrajectory& reference, const WorldOptions& options) {
  auto world = MakeWorld(reference.environment, options);
  if (auto* reacher = dynamic_cast<ReacherEasy*>(world.get()); reacher != nullptr) {
    reacher->PlaceTarget(*reference.target);
  }
  auto* control = dynamic_cast<ControlWorld*>(world.get());
  CHECK(control != nullptr) << reference.environment;
  control->ResetTo(reference.drawn_qpos, reference.drawn_qvel);
  return world;
}

class StateReplay {
 public:
  StateReplay(const StateTrajectory& reference, std::unique_ptr<World> world, ReplayReport* report)
      : reference_(reference),
        world_(std::move(world)),
        report_(*report),
        // In `zero` only positions are judged.
        velocity_tolerance_(report->tolerance == kHopperLandingTolerance ? 0 : report->tolerance) {}

  void Run() {
    CompareState(reference_.reset, 0);
    int index = 0;
    for (const StateStep& step : reference_.steps) {
      const World::Outcome outcome = world_->Step(step.action);
      CompareState(step.after, ++index);
      CompareReward(outcome, step, index);
    }
  }

 private:
  void CompareState(const StateSnapshot& expected, int step) {
    const mjData& data = world_->data();
    report_.Compare("qpos", "", report_.tolerance, {data.qpos, expected.qpos.size()}, expected.qpos,
                    step);
    report_.Compare("qvel", "", velocity_tolerance_, {data.qvel, expected.qvel.size()},
                    expected.qvel, step);
    if (data.ncon != expected.contacts) ++report_.contact_mismatches;
    std::vector<double> observation(expected.observation.size());
    world_->Observe(observation, {}, {});
    if (reference_.environment == "Hopper") {
      for (size_t i = kHopperPositions; i < observation.size(); ++i) {
        observation[i] =
            std::clamp(observation[i], -kLargestVelocityRecorded, kLargestVelocityRecorded);
      }
    }
    report_.Compare("observation", "", velocity_tolerance_, observation, expected.observation,
                    step);
  }

  void CompareReward(const World::Outcome& outcome, const StateStep& expected, int step) {
    const bool always = reference_.variant.starts_with("custom");
    const double reward = always ? *expected.reward_hopper_v4 : expected.reward;
    report_.Compare("reward", "", velocity_tolerance_, {&outcome.reward, 1}, {&reward, 1}, step);
    if (expected.healthy && outcome.terminated == *expected.healthy) {
      ++report_.termination_mismatches;
    }
  }

  const StateTrajectory& reference_;
  const std::unique_ptr<World> world_;
  ReplayReport& report_;
  const double velocity_tolerance_;
};

}  // namespace

ReplayReport ReplayStates(const std::filesystem::path& path, const ReplayOptions& options) {
  const WorldOptions world{
      .model = options.model,
      .physics = options.physics.empty() ? WorldOptions().physics : options.physics};
  const StateTrajectory reference = ReadStateReference(path);
  const bool hopper = reference.environment == "Hopper";
  ReplayReport report;
  report.file = path.string();
  report.environment = hopper ? "Hopper " + reference.variant : reference.environment;
  report.sequence = reference.sequence;
  report.physics = world.physics;
  report.model = world.model;
  report.steps = static_cast<int>(reference.steps.size());
  report.tolerance = !hopper                        ? kControlTolerance
                     : reference.sequence == "zero" ? kHopperLandingTolerance
                                                    : kHopperTolerance;
  StateReplay(reference,
              hopper ? StartHopper(reference, path, world) : StartControl(reference, world),
              &report)
      .Run();
  report.Judge();
  return report;
}

}  // namespace shoal::worlds
