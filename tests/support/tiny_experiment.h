// SPDX-License-Identifier: Apache-2.0
// An experiment of two arms and one seed whose runs take seconds.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace shoal {

// The definition of the experiment; `more` replaces members of the definition.
inline nlohmann::json TinyExperiment(const nlohmann::json& more = nlohmann::json::object(),
                                     int64_t env_steps = 1200) {
  using nlohmann::json;
  json definition{{"schema", "shoal-experiment-definition-1"},
                  {"base", "fetch-reach-state"},
                  {"set",
                   {{"env_steps", env_steps},
                    {"eval.interval", 600},
                    {"eval.episodes", 4},
                    {"learner.threads", 1},
                    {"replay.samples_per_insert", 16},
                    {"stop.success", 2}}},
                  {"arms", {{{"name", "a"}}, {{"name", "b"}, {"set", {{"learner.batch", 64}}}}}},
                  {"seeds", {0}},
                  {"final_episodes", 4}};
  definition.update(more);
  return definition;
}

}  // namespace shoal
