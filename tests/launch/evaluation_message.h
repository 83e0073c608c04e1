// SPDX-License-Identifier: Apache-2.0
// A message of an evaluation actor, with two episodes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

inline EvalMessage EvaluationMessage(uint64_t env_steps, uint64_t updates, double success) {
  EvalMessage message;
  message.env_steps = env_steps;
  message.version = {1, updates};
  message.checkpoint = "step_" + std::to_string(updates);
  message.json =
      nlohmann::json{
          {"schema", "shoal-eval-1"},
          {"env_steps", env_steps},
          {"checkpoint", "step_" + std::to_string(updates)},
          {"weights_version", {{"session", 1}, {"update", updates}}},
          {"episodes", std::vector<nlohmann::json>(2, nlohmann::json::object())},
          {"aggregate",
           {{"success_rate", success},
            {"return_mean", -2.5},
            {"length_mean", 50},
            {"final_distance_mean", 0.25}}},
      }
          .dump();
  return message;
}

}  // namespace shoal::launch
