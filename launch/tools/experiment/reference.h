// SPDX-License-Identifier: Apache-2.0
// Published results of other methods, for comparison with an experiment, from one JSON file (schema
// shoal-reference-1):
//
//   {"schema", "source",
//    "results": [{"method", "source", "task", "frames": [...], "returns": [...]}]}
//
// "source" says what was read where; a result may have a source of its own. `frames` are
// environment frames (env steps x action repeat). docs/experiments.md explains each member.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shoal::launch {

// Mean return of a method on a task.
struct ReferenceResult {
  std::string method{};
  std::string source{};  // empty = the file's source
  std::string task{};
  std::vector<int64_t> frames{};  // increasing, at least one
  std::vector<double> returns{};  // finite; one for each of `frames`
};

struct Reference {
  std::string name{};  // name of the file without extension
  std::string source{};
  std::vector<ReferenceResult> results{};  // no method has two results on one task
};

// Reads a file. Throws Error (usage), in one line that names the file and the member, if a member
// is unknown, missing or ill-typed, or if a method has two results on one task.
Reference ReadReference(const std::filesystem::path& file);
// Reads a reference from JSON. `source` names the JSON in errors.
Reference ParseReference(const nlohmann::ordered_json& object, const std::string& source,
                         const std::string& name);

// Path of a reference from FILE or NAME, a name in the shared references
// (common/config/shared_data.h). Throws Error (usage) listing the existing names.
std::filesystem::path FindReference(const std::string& file_or_name);
std::vector<std::string> ListReferences();  // sorted

}  // namespace shoal::launch
