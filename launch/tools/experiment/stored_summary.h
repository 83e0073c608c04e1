// SPDX-License-Identifier: Apache-2.0
// Reader of a summary.json without the folders of its runs, such as the copies in docs/results.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "launch/tools/experiment/experiment_run_status.h"

namespace shoal::launch {

// Reads the object of a file. The aggregates (success, return, final_distance, at_frames,
// mean_of_tasks, ratios) are computed anew from the rows (`runs` of each arm); all other members
// are unchanged. If the file does not name the rule of n_to_target, an older build wrote the file.
// n_to_target_rule is then set to the rule of that build: two consecutive evaluations that both
// reach the target. If the file is not a shoal-experiment-1 object, throws Error naming the file.
nlohmann::ordered_json ReadStoredSummary(const std::filesystem::path& file);

// Whether a row of a summary has this status.
bool HasStatus(const nlohmann::ordered_json& row, ExperimentRunStatus status);

// Computes the aggregates of a summary from its rows. Throws nlohmann's exceptions if members are
// missing.
void ComputeAggregates(nlohmann::ordered_json* summary);

// Text for the terminal: the question, a line per arm, the returns at environment frames, the
// ratios.
std::string StoredSummaryText(const nlohmann::ordered_json& summary);

}  // namespace shoal::launch
