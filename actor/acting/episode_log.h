// SPDX-License-Identifier: Apache-2.0
// Statistics of one episode, and their means over the most recent episodes, for metrics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "actor/worlds/environment.h"

namespace shoal::actor {

struct EpisodeFigures {
  double episode_return = 0;     // unscaled
  int length = 0;                // env steps
  bool success = false;          // at the end; false for tasks without success
  double final_distance = 0;     // m; NaN for tasks without goals
  double action_smoothness = 0;  // mean over steps of |a_t - a_{t-1}|_2; smaller is smoother
  std::vector<worlds::DrawnMass> drawn_masses{};  // empty unless randomized
};

// Means over the last kWindow episodes. One thread.
class EpisodeLog {
 public:
  static constexpr size_t kWindow = 100;

  void Add(const EpisodeFigures& figures);
  uint64_t count() const { return count_; }
  // Mean of each statistic; all zero before the first episode. `success` is not averaged: see
  // SuccessRate. The drawn masses can be averaged because all episodes of a run randomize the same
  // bodies.
  EpisodeFigures Mean() const;
  double SuccessRate() const;

 private:
  std::deque<EpisodeFigures> recent_;
  uint64_t count_ = 0;
};

}  // namespace shoal::actor
