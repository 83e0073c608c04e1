// SPDX-License-Identifier: Apache-2.0
// Reads the configuration from presets, files and --set, writes it as JSON, and checks it.
//
// If a key is unknown, duplicate, ill-typed or out of range, the functions throw Error (kUsage)
// that names the key, the value and the expectation.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config.h"

namespace shoal {

// Parses strict JSON text: refuses duplicate keys and a nesting beyond kMaxJsonDepth. `source`
// names the text in errors.
nlohmann::json ParseStrictJson(std::string_view text, const std::string& source);

// Applies a (nested) JSON object of keys to `config`. `source` names the object in errors. A former
// name of a key is accepted, with a note on stderr (former_keys.h). An object that has a former and
// the present name of one key is refused.
void ApplyJson(const nlohmann::json& object, const std::string& source, Config* config);

// Does the same without the note, for JSON that Shoal itself has written.
void ApplyStoredJson(const nlohmann::json& object, const std::string& source, Config* config);

// Applies the JSON object in a file, like ApplyJson. The file may be a run's config.json; its spec
// and hashes are skipped.
void ApplyFile(const std::string& path, Config* config);

// Applies assignments such as "learner.batch=256". The value is JSON; a bare word is a string. A
// key that occurs twice in `assignments` is refused.
void ApplyAssignments(const std::vector<std::string>& assignments, Config* config);

// Checks the rules that involve several keys. Call it after all keys were applied. Throws Error
// (kUsage). nn::CheckNetwork checks whether the networks fit the observations.
void Validate(const Config& config);

// Every key, nested, in declaration order.
nlohmann::ordered_json ToJson(const Config& config);

// Hash of the keys that determine the results of a run: all keys except preset, run_name, run_dir,
// env_steps, learner.device and stop.*. A run that is resumed with a larger env_steps keeps its
// hash.
uint64_t ConfigHash(const Config& config);

// Markdown table of every key: default, range, meaning. Source of docs/configuration.md.
std::string DescribeKeys();

// The file of a preset. shared_data.h lists the folders that are searched. If there is no such
// preset, throws Error (kUsage) that lists the existing presets.
std::string FindPreset(const std::string& name);
std::vector<std::string> ListPresets();  // sorted
// Defaults with the preset applied; config.preset is its name.
Config LoadPreset(const std::string& name);

}  // namespace shoal
