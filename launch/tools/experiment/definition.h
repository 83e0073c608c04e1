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
  nlohmann::ordered_json set{};  // {KEY: VALUE}: its difference from the base
  bool operator==(const Arm&) const = default;
};

struct Definition {
  std::string name{};      // "name", else the file's stem; usable as a file name
  std::string base{};      // preset
  std::string question{};  // what the experiment is to answer; may be empty
  nlohmann::ordered_json set = nlohmann::ordered_json::object();  // of every arm
  std::vector<Arm> arms{};              // the first one is what ratios are taken to
  std::vector<int64_t> seeds{};         // unique
  std::optional<int> final_episodes{};  // eval.final_episodes of every run; empty = the preset's
  double target_success = 0.9;          // n_to_target counts the env steps to this success rate
  std::vector<std::string> transfer{};  // further tasks that each finished run is evaluated on
};

// Throws Error (usage) naming the file and the member: unknown, missing or ill-typed members,
// names that are no file names or are given twice.
Definition ReadDefinition(const std::filesystem::path& file);
// The same from JSON; `source` names it in errors, `stem` is the name where it has none.
Definition ParseDefinition(const nlohmann::ordered_json& object, const std::string& source,
                           const std::string& stem);
nlohmann::ordered_json ToJson(const Definition& definition);

// FILE, or NAME of a definition among the experiments of common/config/shared_data.h. Throws Error
// (usage) listing the names there are.
std::filesystem::path FindDefinition(const std::string& file_or_name);
std::vector<std::string> ListDefinitions();  // sorted

// The preset with the definition's own `set` and final_episodes applied. `defaults` ("KEY=VALUE")
// hold for keys that neither sets. Throws Error (usage) naming `source` where the preset is unknown
// or a key is refused.
Config ResolveBase(const Definition& definition, const std::string& source,
                   const std::vector<std::string>& defaults = {});

// The base with the arm's differences; the seed is set for each run. Refuses, by the
// configuration's own key table, what no run could start with: unknown, ill-typed or out-of-range
// keys, keys that the experiment itself sets, combinations that make no sense, an unknown task,
// another environment of Python than the base's.
// Throws Error (usage) naming `source` and the arm.
Config ArmConfig(const Config& base, const Arm& arm, const std::string& source);

// Refuses unknown tasks in `transfer`; those of one's own are known once an arm's configuration has
// been made. Throws Error (usage) naming `source`.
void CheckTransfer(const Definition& definition, const std::string& source);

}  // namespace shoal::launch
