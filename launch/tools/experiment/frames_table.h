// SPDX-License-Identifier: Apache-2.0
// Returns at environment frames as members of summary.json, and as tables.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "launch/tools/experiment/aligned_table.h"
#include "launch/tools/experiment/frames_results.h"

namespace shoal::launch {

// [{frames, env_steps, episodes, return_mean}]: `at_frames` of a run.
nlohmann::ordered_json AtFramesJson(const std::vector<ReturnAtFrames>& returns);
// {name, source, at_frames: [{method, task, frames, return}]}: `reference` of a summary.
nlohmann::ordered_json ReferenceJson(const FramesResults& results);
// Sets the aggregates of a summary: `at_frames` of each arm, and `mean_of_tasks` if the arms are
// different tasks. The arms of `results` are those of the summary.
void SetFramesAggregates(const FramesResults& results, nlohmann::ordered_json* summary);

// Reads the results back from the rows of a summary, without its aggregates; no frames if the
// summary has none. Throws nlohmann::json::exception if a member is missing or ill-typed.
FramesResults ReadFramesResults(const nlohmann::ordered_json& summary);

// A row of headings, a row per arm, and, if the arms are different tasks, a row with the mean over
// tasks. One column for each of the frames.
std::vector<TableRow> FramesRows(const FramesResults& results);
// The published returns at `frames`: a row of headings, a row per task, and a row with the mean
// over tasks if the arms are different tasks. One column for each method.
std::vector<TableRow> PublishedRows(const FramesResults& results, int64_t frames);
// The frames for which the reference has returns.
std::vector<int64_t> PublishedFrames(const FramesResults& results);

// Text for the terminal: all of these tables; empty without frames.
std::string FramesText(const FramesResults& results);

}  // namespace shoal::launch
