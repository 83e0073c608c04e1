#include <algorithm>
#include <set>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

constexpr int64_t kMaxFrameBytes = 1'000'000;  // a record must fit one DDS sample

void ValidateObservation(const ObservationConfig& observation) {
  const bool vectors = observation.goal_mode != "none" || observation.proprioception;
  if (!observation.pixels && !vectors) {
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

// 3x3 convolutions without padding must leave at least one pixel.
void ValidateEncoder(const NetworkConfig& network, const ObservationConfig& observation) {
  if (network.filters.empty() || network.filters.size() != network.strides.size()) {
    throw UsageError(
        "network.filters has {} entries and network.strides {}: expected as many, >= 1",
        network.filters.size(), network.strides.size());
  }
  if (observation.height % network.pool != 0 || observation.width % network.pool != 0) {
    throw UsageError("network.pool = {}: expected a divisor of the image size {}x{}", network.pool,
                     observation.height, observation.width);
  }
  int height = observation.height / network.pool, width = observation.width / network.pool;
  for (size_t i = 0; i < network.strides.size(); ++i) {
    if (height < 3 || width < 3) {
      throw UsageError("network.strides: images of {}x{} shrink to {}x{} before convolution {}",
                       observation.height, observation.width, height, width, i + 1);
    }
    height = (height - 3) / network.strides[i] + 1;
    width = (width - 3) / network.strides[i] + 1;
  }
}

}  // namespace

void Validate(const Config& config) {
  ValidateObservation(config.observation);
  if (config.observation.pixels) ValidateEncoder(config.network, config.observation);
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
