// SPDX-License-Identifier: Apache-2.0
// An environment without physics. Every observed number encodes its episode and step.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actor/worlds/environment.h"
#include "actor/worlds/episode_fault.h"

namespace shoal::actor {

// All bytes of a frame (2, 4, 4) are 10 * (key % 10) + step. The vector is {key % 1000, step}. The
// reward is the first component of the action; a reward above 0.5 is a success. The distance is 100
// - step. Episodes end after `length` steps: truncated if the key is odd, else terminated. All
// bytes of the goal picture are 200 + key % 10.
class CountingEnvironment final : public worlds::Environment {
 public:
  static constexpr int kLength = 3;

  explicit CountingEnvironment(int length = kLength, int stack = 2, bool goal_picture = false)
      : length_(length) {
    spec_.goal_picture = goal_picture;
    spec_.task = "FetchReachDense";
    spec_.channels = 2;
    spec_.height = spec_.width = 4;
    spec_.stack = stack;
    spec_.blocks = {{"observation", 2}};
    spec_.action_size = 2;
  }

  const ObservationSpec& spec() const override { return spec_; }

  float Reset(uint64_t stream_key, worlds::ObservationOut out) override {
    key_ = stream_key;
    step_ = 0;
    ThrowIfFaulty(0);
    masses_ = {{"leg", static_cast<double>(key_ % 1000)}};
    if (spec_.goal_picture) {
      goal_picture_.assign(static_cast<size_t>(spec_.FrameBytes()),
                           static_cast<uint8_t>(200 + key_ % 10));
    }
    Observe(out);
    return 100;
  }

  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out) override {
    EXPECT_LT(step_, length_) << "stepped beyond the episode's end";
    ThrowIfFaulty(step_ + 1);
    ++step_;
    Observe(out);
    const bool last = step_ == length_;
    return {.reward = action[0],
            .terminated = last && key_ % 2 == 0,
            .truncated = last && key_ % 2 == 1,
            .success = action[0] > 0.5F,
            .distance = static_cast<float>(100 - step_)};
  }

  // Returns whether an episode is faulty at a step; step 0 = the episode's reset.
  std::function<bool(uint64_t key, int step)> faulty;

  // Reported time of the user's code; empty = the environment is a world of Shoal.
  std::optional<double> users_share;

  double render_seconds() const override { return 0; }
  std::optional<double> user_seconds() const override { return users_share; }
  std::span<const worlds::DrawnMass> drawn_masses() const override { return masses_; }
  std::span<const uint8_t> goal_picture() const override { return goal_picture_; }

 private:
  void ThrowIfFaulty(int step) const {
    if (faulty && faulty(key_, step)) {
      throw worlds::EpisodeFault(worlds::FaultCause::kDiverged,
                                 "a fault at step " + std::to_string(step));
    }
  }

  void Observe(worlds::ObservationOut out) const {
    std::ranges::fill(out.frame,
                      static_cast<uint8_t>(10 * (key_ % 10) + static_cast<uint64_t>(step_)));
    out.vector[0] = static_cast<float>(key_ % 1000);
    out.vector[1] = static_cast<float>(step_);
  }

  ObservationSpec spec_;
  const int length_;
  uint64_t key_ = 0;
  int step_ = 0;
  std::vector<worlds::DrawnMass> masses_;
  std::vector<uint8_t> goal_picture_;
};

}  // namespace shoal::actor
