// SPDX-License-Identifier: Apache-2.0
// One summary from the summaries of an experiment whose runs are in several folders, for example on
// several machines.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace shoal::launch {

// Reads the files (ReadStoredSummary). Each run has the row of the file in which the run got
// furthest; the aggregates are those of these rows. All other members are those of the first file.
// Throws Error
//   - if the files are of different experiments: name, base, or the arms with their settings,
//   - if two files have different rows of a run that ended, because the choice would be arbitrary.
nlohmann::ordered_json ReadMergedSummary(const std::vector<std::filesystem::path>& files);

}  // namespace shoal::launch
