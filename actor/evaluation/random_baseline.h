// SPDX-License-Identifier: Apache-2.0
// Baselines: results of uniform random actions and of no-op actions, which a policy must beat.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace shoal::actor {

struct RandomRequest {
  std::string task;
  std::string model = "";  // path of another MJCF file; empty = our own
  int episodes = 100;
  int64_t seed = 1;
  std::string policy = "random";  // or "noop": every action is zero
  double distance_threshold = 0;  // m; 0 = the task's own
  int action_repeat = 0;          // 0 = the task's own
  std::string physics = "mujoco2";
  bool end_on_success = false;
};

// Whole episodes of the final stream, as `shoal eval` plays them. Schema shoal-eval-1 with policy
// "random" or "noop", and success_by_threshold: [{threshold (m), success_rate}] over the distances
// at the episodes' ends, for judging whether a threshold says anything; null for tasks without
// goals. Throws Error (kUsage) on an unknown task or policy, listing those there are, and when
// `stop`, asked after each step, says so.
nlohmann::ordered_json PlayRandom(const RandomRequest& request, const std::function<bool()>& stop);

// For people: means over the episodes, then the success rate by threshold.
std::string RandomText(const nlohmann::ordered_json& result);

}  // namespace shoal::actor
