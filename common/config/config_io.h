// SPDX-License-Identifier: Apache-2.0
// Reads the configuration from presets, files and --set, writes it as JSON, and checks it.
//
// Every unknown, duplicate, ill-typed or out-of-range key is refused with Error (kUsage) naming the
// key, the value and what was expected.
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
// name of a key is accepted, with a note on stderr (former_keys.h). Both names of one key together
// are refused.
void ApplyJson(const nlohmann::json& object, const std::string& source, Config* config);

// Does the same without the note, for JSON that Shoal itself has written.
void ApplyStoredJson(const nlohmann::json& object, const std::string& source, Config* config);

// Applies a file's content as ApplyJson does. A run's config.json is accepted too; its spec and
// hashes are skipped.
void ApplyFile(const std::string& path, Config* config);

// Applies one "learner.batch=256" (value as JSON; a bare word is a string). A key given twice in
// `assignments` is refused.
void ApplyAssignments(const std::vector<std::string>& assignments, Config* config);

// Checks that depend on several keys, after everything is applied. Throws Error (kUsage).
// nn::CheckNetwork checks that the networks fit the observations.
void Validate(const Config& config);

// Every key, nested, in declaration order.
nlohmann::ordered_json ToJson(const Config& config);

// Hash of everything that decides the results of a run: every key but preset, run_name, run_dir,
// env_steps and stop.*, so that a resumed run may train for longer.
uint64_t ConfigHash(const Config& config);

// Markdown table of every key: default, range, meaning. Source of docs/configuration.md.
std::string DescribeKeys();

// The file of a preset, found as shared_data.h says: in the project, beside the program or in the
// installation. Throws Error (kUsage) listing the existing presets.
std::string FindPreset(const std::string& name);
std::vector<std::string> ListPresets();  // sorted
// Defaults with the preset applied; config.preset is its name.
Config LoadPreset(const std::string& name);

}  // namespace shoal
