// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/merged_summary.h"

#include <cstdint>
#include <map>
#include <string>

#include "common/base/check.h"
#include "common/base/error.h"
#include "launch/tools/experiment/experiment_run_status.h"
#include "launch/tools/experiment/stored_summary.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

using RowsBySeed = std::map<int64_t, ordered_json>;

// Members that are equal in all summaries of one experiment.
ordered_json IdentityOf(const ordered_json& summary) {
  ordered_json identity{{"name", summary.at("name")}, {"base", summary.value("base", "")}};
  for (const ordered_json& arm : summary.at("arms")) {
    identity["arms"].push_back({arm.at("name"), arm.value("overrides", ordered_json())});
  }
  return identity;
}

bool Ended(const ordered_json& row) {
  return HasStatus(row, ExperimentRunStatus::kFinished) ||
         HasStatus(row, ExperimentRunStatus::kFailed);
}

// Takes the row unless the run got further in another file. `file` and `arm` are for the error.
void Take(const ordered_json& row, const std::filesystem::path& file, const std::string& arm,
          RowsBySeed* rows) {
  const auto seed = row.at("seed").get<int64_t>();
  const auto [at, is_new] = rows->try_emplace(seed, row);
  ordered_json& other = at->second;
  if (is_new || other == row) return;
  if (Ended(other) && Ended(row)) {
    throw UsageError("'{}': seed {} of arm {} has ended with other results in an earlier file",
                     file.string(), seed, arm);
  }
  if (Ended(row) || HasStatus(other, ExperimentRunStatus::kMissing)) other = row;
}

ordered_json Merge(const std::vector<std::filesystem::path>& files) {
  ordered_json merged;
  std::vector<RowsBySeed> arms;
  for (const std::filesystem::path& file : files) {
    const ordered_json summary = ReadStoredSummary(file);
    if (merged.is_null()) {
      merged = summary;
      arms.resize(summary.at("arms").size());
    }
    if (IdentityOf(summary) != IdentityOf(merged)) {
      throw UsageError("'{}': expected the name, base and arms of '{}'", file.string(),
                       files[0].string());
    }
    for (size_t i = 0; i < arms.size(); ++i) {
      const ordered_json& arm = summary.at("arms").at(i);
      const auto name = arm.at("name").get<std::string>();
      for (const ordered_json& row : arm.at("runs")) Take(row, file, name, &arms[i]);
    }
  }
  for (size_t i = 0; i < arms.size(); ++i) {
    ordered_json rows = ordered_json::array();
    for (const auto& [seed, row] : arms[i]) rows.push_back(row);
    merged.at("arms").at(i).at("runs") = rows;
  }
  ComputeAggregates(&merged);
  return merged;
}

}  // namespace

ordered_json ReadMergedSummary(const std::vector<std::filesystem::path>& files) {
  CHECK(!files.empty());
  if (files.size() == 1) return ReadStoredSummary(files[0]);
  try {
    return Merge(files);
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("the summaries cannot be combined: {}", e.what());
  }
}

}  // namespace shoal::launch
