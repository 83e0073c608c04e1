// SPDX-License-Identifier: Apache-2.0
// An environment that a test steps directly, without an actor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "actor/worlds/environment.h"
#include "common/base/random.h"
#include "common/config/config.h"

namespace shoal::worlds {

inline Config StateOnly(const std::string& task = "FetchReachDense") {
  Config config;
  config.task = task;
  config.observation.pixels = false;
  config.observation.goal_mode = "both";
  return config;
}

inline std::unique_ptr<Environment> Make(const Config& config) {
  return MakeEnvironment(config, config.observation.pixels ? MakeRenderContext(config.observation)
                                                           : std::shared_ptr<RenderContext>());
}

// An environment, buffers for its observations, and a stream of random actions.
struct Player {
  explicit Player(std::unique_ptr<Environment> made)
      : environment(std::move(made)),
        frame(static_cast<size_t>(environment->spec().FrameBytes())),
        vector(static_cast<size_t>(environment->spec().RecordedVectorSize())) {}

  float Reset(uint64_t key) {
    actions = Random(key + 1);
    return environment->Reset(key, {frame, vector});
  }
  StepResult Step() {
    std::array<float, 4> action{};
    for (float& component : action) component = static_cast<float>(actions.Uniform(-1, 1));
    return environment->Step(action, {frame, vector});
  }
  // Frames and vectors of the reset and `steps` steps.
  std::pair<std::vector<uint8_t>, std::vector<float>> Play(uint64_t key, int steps) {
    Reset(key);
    auto seen = std::pair(frame, vector);
    for (int i = 0; i < steps; ++i) {
      Step();
      seen.first.insert(seen.first.end(), frame.begin(), frame.end());
      seen.second.insert(seen.second.end(), vector.begin(), vector.end());
    }
    return seen;
  }

  std::unique_ptr<Environment> environment;
  std::vector<uint8_t> frame;
  std::vector<float> vector;
  Random actions{0};
};

}  // namespace shoal::worlds
