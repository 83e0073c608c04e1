// SPDX-License-Identifier: Apache-2.0
// A cheap environment for simulations: episodes of fixed length, steps of a fixed simulated
// duration. The first two numbers of an observation identify the episode and the step. The reward
// is the action's first number.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "actor/acting/environments.h"
#include "actor/worlds/environment.h"
#include "common/base/random.h"
#include "common/base/sleep.h"
#include "common/config/run_config.h"

namespace shoal::simulation {

class FakeEnvironment final : public worlds::Environment {
 public:
  FakeEnvironment(const ObservationSpec& spec, std::chrono::microseconds step)
      : spec_(spec), step_(step), random_(0) {}

  const ObservationSpec& spec() const override { return spec_; }

  float Reset(uint64_t stream_key, worlds::ObservationOut out) override {
    random_ = Random(stream_key);
    episode_ = static_cast<float>(random_.Below(1 << 24));
    steps_ = 0;
    Observe(out);
    return 1;
  }

  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out) override {
    SleepFor(step_);
    ++steps_;
    Observe(out);
    return {.reward = action[0], .truncated = steps_ == kEpisodeSteps, .distance = 1};
  }

  double render_seconds() const override { return 0; }
  std::span<const worlds::DrawnMass> drawn_masses() const override { return {}; }

  static constexpr int kEpisodeSteps = 10;

 private:
  void Observe(worlds::ObservationOut out) {
    std::ranges::fill(out.frame, static_cast<uint8_t>(random_.Next()));
    for (float& value : out.vector) value = static_cast<float>(random_.Uniform(-1, 1));
    out.vector[0] = episode_;
    out.vector[1] = static_cast<float>(steps_);
  }

  const ObservationSpec spec_;
  const std::chrono::microseconds step_;
  Random random_;
  float episode_ = 0;
  int steps_ = 0;
};

inline actor::EnvironmentFactory FakeEnvironments(std::chrono::microseconds step) {
  return [step](const RunConfig& run, int count) {
    std::vector<std::unique_ptr<worlds::Environment>> environments;
    for (int i = 0; i < count; ++i) {
      environments.push_back(std::make_unique<FakeEnvironment>(run.spec, step));
    }
    return environments;
  };
}

}  // namespace shoal::simulation
