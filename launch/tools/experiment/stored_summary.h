// SPDX-License-Identifier: Apache-2.0
// A summary.json without the folders of its runs, as the copies in docs/results are.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace shoal::launch {

// The object of a file, with its aggregates (success, return, final_distance, ratios) computed from
// its own rows (`runs` of each arm) and everything else as it was. A file that does not name the
// rule by which n_to_target was found is of a build that asked each of two evaluations:
// n_to_target_rule says so. Throws Error naming the file where it is no shoal-experiment-1 object.
nlohmann::ordered_json ReadStoredSummary(const std::filesystem::path& file);

// For people: the question, a line per arm, the ratios.
std::string StoredSummaryText(const nlohmann::ordered_json& summary);

}  // namespace shoal::launch
