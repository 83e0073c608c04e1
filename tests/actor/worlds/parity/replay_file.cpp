// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/replay_file.h"

#include <memory>

#include "actor/worlds/fetch_world.h"
#include "actor/worlds/tools/measurement_reader.h"
#include "actor/worlds/tools/reference_file.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "tests/actor/worlds/parity/cross_version_file.h"
#include "tests/actor/worlds/parity/replay_states.h"
#include "tests/actor/worlds/parity/state_reference.h"

namespace shoal::worlds {
namespace {

constexpr const char* kReplayedVersion = "3.3.8";
// Pictures of the originals, which lie beside the trajectories (frame_parity_test reads them).
constexpr const char* kPicturesFormat = "vrl-frames-1";
constexpr double kStateTolerance = 1e-3, kDriftTolerance = 3e-3, kFoldingTolerance = 1.5e-2;

ReplayReport ReplaySequence(const std::filesystem::path& path, const CrossVersionSequence& sequence,
                            const std::string& physics) {
  ReplayReport report;
  report.file = path.string();
  report.environment = sequence.task + ", MuJoCo " + sequence.version;
  report.sequence = sequence.sequence;
  report.physics = physics;
  report.steps = static_cast<int>(sequence.actions.size());
  report.tolerance = CrossVersionTolerance(sequence.task, sequence.sequence);
  const std::unique_ptr<World> made = MakeWorld(sequence.task, {.model = "", .physics = physics});
  auto& world = dynamic_cast<FetchWorld&>(*made);
  report.Compare("initial_grip", "m", report.tolerance, world.arm().initial_grip(),
                 sequence.initial_grip, 0);
  world.ResetTo(sequence.desired_goal, sequence.object_xy);
  for (size_t i = 0; i < sequence.actions.size(); ++i) {
    world.Step(sequence.actions[i]);
    report.Compare("grip_position", "m", report.tolerance, world.arm().GripPosition(),
                   sequence.grip[i], static_cast<int>(i) + 1);
  }
  report.Judge();
  return report;
}

}  // namespace

double CrossVersionTolerance(const std::string& task, const std::string& sequence) {
  if (sequence == "const_y") return kFoldingTolerance;
  const bool aloft = task == "FetchReach" || task == "FetchPickAndPlace";
  return sequence == "zero" && aloft ? kDriftTolerance : kStateTolerance;
}

std::vector<ReplayReport> ReplayFile(const std::filesystem::path& path,
                                     const ReplayOptions& options) {
  const nlohmann::json document = ReadJson(path);
  const MeasurementReader root(path, document, "");
  const std::string format = root.Text("format");
  if (format == kPicturesFormat) {
    log::Warning("{}: skipped: it holds pictures ({}), no trajectory", path.string(), format);
    return {};
  }
  if (format != kCrossVersionFormat) {
    if (format != kReferenceFormat) {
      throw root.Fault("key 'format'", fmt::format("is '{}'; expected '{}' or '{}'", format,
                                                   kReferenceFormat, kCrossVersionFormat));
    }
    const std::string environment = root.Text("env");
    if (IsStateEnvironment(environment)) return {ReplayStates(path, options)};
    if (!environment.starts_with("Fetch")) {
      throw root.Fault("key 'env'",
                       fmt::format("is '{}', which cannot be replayed; known: Fetch..., {}",
                                   environment, StateEnvironments()));
    }
    return {ReplayReference(path, options)};
  }
  if (!options.model.empty()) {
    throw UsageError("'{}' holds several tasks; it cannot be replayed with one model file",
                     path.string());
  }
  const std::string physics = options.physics.empty() ? "mujoco3" : options.physics;
  const CrossVersionFile file = ReadCrossVersions(path, kReplayedVersion);
  for (const std::string& name : file.left_out) {
    log::Warning("{}: {} skipped: no trajectory beside the file tells its actions", path.string(),
                 name);
  }
  std::vector<ReplayReport> reports;
  for (const CrossVersionSequence& sequence : file.sequences) {
    reports.push_back(ReplaySequence(path, sequence, physics));
  }
  return reports;
}

}  // namespace shoal::worlds
