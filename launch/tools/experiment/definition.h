// SPDX-License-Identifier: Apache-2.0
// Definition of an experiment: arms (named differences from a base preset) x seeds, from one JSON
// file (schema shoal-experiment-definition-1):
//
//   {"schema", "base": PRESET, "set": {KEY: VALUE}, "arms": [{"name", "set": {KEY: VALUE}}],
//    "seeds": [...], "final_episodes", "name", "target_success", "question", "transfer": [TASK],
//    "frames": [...], "reference": NAME}
//
// Keys are dotted ("learner.batch"), as for --set. docs/experiments.md explains each member.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace shoal::launch {

struct Arm {
  std::string name{};            // usable as a file name; unique
  nlohmann::ordered_json set{};  // {KEY: VALUE}: differences from the base
  bool operator==(const Arm&) const = default;
};

struct Definition {
  std::string name{};      // "name", else the file's name without extension; a valid file name
  std::string base{};      // preset
  std::string question{};  // the question of the experiment; may be empty
  nlohmann::ordered_json set = nlohmann::ordered_json::object();  // keys set in every arm
  std::vector<Arm> arms{};                                        // ratios refer to the first arm
  std::vector<int64_t> seeds{};                                   // unique
  std::optional<int> final_episodes{};  // eval.final_episodes of the runs; empty = as in the preset
  double target_success = 0.9;          // n_to_target counts the env steps to this success rate
  std::vector<std::string> transfer{};  // further tasks on which each finished run is evaluated
  // Environment frames at which the summary shows the mean return; increasing, may be empty.
  std::vector<int64_t> frames{};
  std::string reference{};  // name of published results (reference.h); empty = none
};

// Throws Error (usage) naming the file and the member if a member is unknown, missing or ill-typed,
// or if a name is not a valid file name or occurs twice.
Definition ReadDefinition(const std::filesystem::path& file);
// Reads a definition from JSON. `source` names the JSON in errors; `stem` is the definition's name
// if the JSON has no name.
Definition ParseDefinition(const nlohmann::ordered_json& object, const std::string& source,
                           const std::string& stem);
nlohmann::ordered_json ToJson(const Definition& definition);

// Path of a definition from FILE or NAME, a name in the shared experiments
// (common/config/shared_data.h). Throws Error (usage) listing the existing names.
std::filesystem::path FindDefinition(const std::string& file_or_name);
std::vector<std::string> ListDefinitions();  // sorted

// The preset with the definition's `set` and final_episodes applied. `defaults` ("KEY=VALUE") apply
// to keys that neither the preset nor the definition sets. Throws Error (usage) naming `source` if
// the preset is unknown or a key is refused.
Config ResolveBase(const Definition& definition, const std::string& source,
                   const std::vector<std::string>& defaults = {});

// The base with the arm's differences; the seed is set for each run. Throws Error (usage) naming
// `source` and the arm if no run could start with this configuration: unknown, ill-typed or
// out-of-range keys, keys that the experiment itself sets, combinations that contradict each other,
// an unknown task, a Python environment other than that of the base.
Config ArmConfig(const Config& base, const Arm& arm, const std::string& source);

// Throws Error (usage) naming `source` if `transfer` contains an unknown task. Call it after an
// arm's configuration has been resolved, because a user's tasks are not known earlier.
void CheckTransfer(const Definition& definition, const std::string& source);
// Throws Error (usage) naming `source` if the reference does not exist or is refused (reference.h).
void CheckReference(const Definition& definition, const std::string& source);

}  // namespace shoal::launch
