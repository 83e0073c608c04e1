// SPDX-License-Identifier: Apache-2.0
#include "launch/check/world_lines.h"

#include <fmt/core.h>

#include <algorithm>

#include "actor/worlds/tools/replay_reference.h"
#include "actor/worlds/tools/robot_in_picture.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/tasks/task_registry.h"
#include "launch/check/parity_reference.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {
namespace {

// The arm covers at least a tenth of a correct picture; a broken one has only noise.
constexpr double kLeastShare = 0.02;
constexpr char kRobot[] = "robot0:";  // prefix of its bodies' names

}  // namespace

CheckLine JudgePicture(const std::string& camera, double share) {
  CheckLine line{"rendering", Verdict::kOk, fmt::format("{} {:.0f} %", camera, 100 * share), ""};
  if (share < kLeastShare) {
    line.verdict = Verdict::kFail;
    line.finding = fmt::format(
        "the robot covers {:.1f} % of camera {}'s picture, expected {:.0f} % "
        "at least",
        100 * share, camera, 100 * kLeastShare);
    line.advice = "run the renderer's tests: ./run test -R Pictures";
  }
  return line;
}

CheckLine LookAtPictures(const Config& config) {
  const ObservationConfig& observation = config.observation;
  const auto world =
      worlds::MakeWorld(tasks::FindTask(config.task).world(), {config.model, config.physics});
  std::string shares;
  for (const std::string& camera : observation.cameras) {
    CheckLine line =
        JudgePicture(camera, worlds::RobotShare(world.get(), kRobot, camera, observation));
    if (line.verdict != Verdict::kOk) return line;
    shares += (shares.empty() ? "" : ", ") + line.finding;
  }
  return {
      "rendering", Verdict::kOk,
      fmt::format("quality {} at {}x{}; share of each camera's picture that the robot covers: {}",
                  observation.quality, observation.width, observation.height, shares),
      ""};
}

CheckLine LookAtOpenGl(Config config) {
  config.observation.quality = "fast";
  CheckLine line;
  try {
    line = LookAtPictures(config);
    if (line.verdict != Verdict::kOk) {
      line.advice =
          "OSMesa draws, but not the scene: install Debian's libosmesa6 and unset MESA_* "
          "and GALLIUM_* in the environment, or set observation.quality=native";
    }
  } catch (const Error& error) {
    line.verdict = Verdict::kFail;
    line.finding = error.what();
    line.advice = "install libosmesa6, or set observation.quality=native in every run";
  }
  line.name = "opengl";
  if (line.verdict == Verdict::kFail) line.verdict = Verdict::kWarn;
  return line;
}

CheckLine LookAtPhysics() {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "reference.json";
  WriteFileAtomically(file, ParityReference());
  const worlds::ReplayReport report = worlds::ReplayReference(file);
  const auto worst =
      std::ranges::max_element(report.deviations, {}, [](const worlds::Deviation& deviation) {
        return deviation.tolerance > 0 ? deviation.largest : -1;
      });
  CheckLine line{
      "physics", Verdict::kOk,
      fmt::format("{} steps of the original {}: at most {:.1e} {} apart ({})", report.steps,
                  report.environment, worst->largest, worst->unit, worst->quantity),
      ""};
  if (!report.passed) {
    line.verdict = Verdict::kFail;
    line.finding +=
        fmt::format(", allowed {:.0e}; {} reward and {} success mismatches", report.tolerance,
                    report.reward_mismatches, report.success_mismatches);
    line.advice = "use Debian's libmujoco2.2.2: another engine has other physics";
  }
  return line;
}

}  // namespace shoal::launch
