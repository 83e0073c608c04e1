// SPDX-License-Identifier: Apache-2.0
// Baselines for a policy: results of uniform random actions and of no-op actions.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace shoal::actor {

struct RandomRequest {
  std::string task;
  std::string model = "";  // path of another MJCF file; empty = the built-in model
  int episodes = 100;
  int64_t seed = 1;
  std::string policy = "random";  // or "noop": every action is zero
  double distance_threshold = 0;  // m; 0 = the task's own threshold
  int action_repeat = 0;          // control steps per env step; 0 = the task's own number
  std::string physics = "mujoco2";
  bool end_on_success = false;
};

// Plays whole episodes of the final stream, like `shoal eval`. Schema shoal-eval-1 with policy
// "random" or "noop", and success_by_threshold: [{threshold (m), success_rate}], computed from the
// final distances; null for tasks without goals. The rates show whether a threshold is too easy.
// `stop` is called after each step. Throws Error (kUsage) if `stop` returns true, and if the task
// or the policy is unknown; the message then lists the known names.
nlohmann::ordered_json PlayRandom(const RandomRequest& request, const std::function<bool()>& stop);

// The result as text: means over the episodes, then the success rate by threshold.
std::string RandomText(const nlohmann::ordered_json& result);

}  // namespace shoal::actor
