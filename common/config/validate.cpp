#include <algorithm>
#include <set>

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/config/exploration_kind.h"

namespace shoal {
namespace {

constexpr int64_t kMaxFrameBytes = 1'000'000;  // a record must fit one DDS sample

void ValidateObservation(const ObservationConfig& observation) {
  if (!observation.pixels && observation.goal_mode == "none" && !observation.proprioception) {
    throw UsageError(
        "observation.pixels = false, goal_mode = none, proprioception = false: nothing to observe");
  }
  if (!observation.pixels) return;
  if (observation.cameras.empty()) {
    throw UsageError("observation.cameras = []: expected at least one camera (or pixels = false)");
  }
  std::set<std::string> seen;
  for (const std::string& camera : observation.cameras) {
    if (camera.empty()) throw UsageError("observation.cameras: a camera's name is empty");
    if (!seen.insert(camera).second) {
      throw UsageError("observation.cameras: '{}' is listed twice", camera);
    }
  }
  const int64_t channels =
      static_cast<int64_t>(observation.cameras.size()) * (observation.grey ? 1 : 3);
  const int64_t bytes = channels * observation.height * observation.width;
  if (bytes > kMaxFrameBytes) {
    throw UsageError(
        "observation: a frame of {} channels at {}x{} has {} bytes, at most {} allowed", channels,
        observation.height, observation.width, bytes, kMaxFrameBytes);
  }
}

void ValidateExploration(const Config& config) {
  const ExplorationConfig& exploration = config.exploration;
  if (exploration.kind == "squashed_gaussian" && !LearnsDeviation(config)) {
    throw UsageError(
        "exploration.kind = squashed_gaussian: the policy of learner.algorithm = {} has no "
        "deviation of its own; expected auto | gaussian | ou",
        config.learner.algorithm);
  }
  if (exploration.theta * exploration.dt > 1) {
    throw UsageError(
        "exploration.theta = {}, exploration.dt = {}: expected a product of at most 1, else the "
        "noise overshoots zero in each step",
        exploration.theta, exploration.dt);
  }
}

}  // namespace

void Validate(const Config& config) {
  ValidateObservation(config.observation);
  ValidateExploration(config);
  if (config.run_dir.empty()) throw UsageError("run_dir = \"\": expected a folder");
  if (config.transport.interface.empty()) {
    throw UsageError("transport.interface = \"\": expected a network interface");
  }
  if (config.replay.min_size > config.replay.capacity / 2) {
    throw UsageError("replay.min_size = {}: expected at most half of replay.capacity = {}",
                     config.replay.min_size, config.replay.capacity);
  }
  const ObservationConfig& images = config.observation;
  if (images.pixels && config.replay.shift_pad * 2 >= std::min(images.height, images.width)) {
    throw UsageError(
        "replay.shift_pad = {}: expected less than half of the images' shorter side, "
        "observation.height = {}, observation.width = {}",
        config.replay.shift_pad, images.height, images.width);
  }
  if (config.learner.batch % config.replay.copies != 0) {
    throw UsageError("replay.copies = {}: expected a divisor of learner.batch = {}",
                     config.replay.copies, config.learner.batch);
  }
  if (config.lockstep && config.actors > 1) {
    throw UsageError("actors = {}: lockstep takes one actor", config.actors);
  }
}

}  // namespace shoal
