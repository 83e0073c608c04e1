// SPDX-License-Identifier: Apache-2.0
// Definition of an experiment: arms (named differences from a base preset) x seeds, from one JSON
// file (schema shoal-experiment-definition-1):
//
//   {"schema", "base": PRESET, "set": {KEY: VALUE}, "arms": [{"name", "set": {KEY: VALUE}}],
//    "seeds": [...], "final_episodes", "name", "target_success", "question", "transfer": [TASK]}
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
  std::string name{};      // "name", else the file's stem; usable as a file name
  std::string base{};      // preset
  std::string question{};  // the question of the experiment; may be empty
  nlohmann::ordered_json set = nlohmann::ordered_json::object();  // of every arm
  std::vector<Arm> arms{};                                        // ratios refer to the first one
  std::vector<int64_t> seeds{};                                   // unique
  std::optional<int> final_episodes{};  // eval.final_episodes of every run; empty = the preset's
  double target_success = 0.9;          // n_to_target counts the env steps to this success rate
  std::vector<std::string> transfer{};  // further tasks that each finished run is evaluated on
};

// Throws Error (usage) naming the file and the member: unknown, missing or ill-typed members, names
// that are not valid file names or occur twice.
Definition ReadDefinition(const std::filesystem::path& file);
// Reads a definition from JSON. `source` names the JSON in errors; `stem` is the name if the JSON
// has none.
Definition ParseDefinition(const nlohmann::ordered_json& object, const std::string& source,
                           const std::string& stem);
nlohmann::ordered_json ToJson(const Definition& definition);

// Path of a definition from FILE or NAME, a name in the shared experiments
// (common/config/shared_data.h). Throws Error (usage) listing the existing names.
std::filesystem::path FindDefinition(const std::string& file_or_name);
std::vector<std::string> ListDefinitions();  // sorted

// The preset with the definition's own `set` and final_episodes applied. `defaults` ("KEY=VALUE")
// apply to keys that neither of them sets. Throws Error (usage) naming `source` if the preset is
// unknown or a key is refused.
Config ResolveBase(const Definition& definition, const std::string& source,
                   const std::vector<std::string>& defaults = {});

// The base with the arm's differences; the seed is set for each run. Refuses a configuration that
// no run could start with, by the configuration's key table: unknown, ill-typed or out-of-range
// keys, keys that the experiment itself sets, combinations that contradict each other, an unknown
// task, a Python environment other than the base's. Throws Error (usage) naming `source` and the
// arm.
Config ArmConfig(const Config& base, const Arm& arm, const std::string& source);

// Refuses unknown tasks in `transfer`. Tasks of the user's own are known only after an arm's
// configuration has been resolved. Throws Error (usage) naming `source`.
void CheckTransfer(const Definition& definition, const std::string& source);

}  // namespace shoal::launch
