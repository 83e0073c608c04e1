// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/stored_summary.h"

#include <fmt/core.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "launch/tools/experiment/arm_table.h"
#include "launch/tools/experiment/frames_table.h"
#include "launch/tools/experiment/statistics_json.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

std::optional<double> NumberOf(const ordered_json& row, const char* name) {
  const auto found = row.find(name);
  if (found == row.end() || found->is_null()) return std::nullopt;
  return found->get<double>();
}

SeedFigures RowFigures(const ordered_json& arm) {
  SeedFigures figures;
  for (const ordered_json& row : arm.at("runs")) {
    if (HasStatus(row, ExperimentRunStatus::kFailed)) ++figures.failed;
    const auto return_mean = NumberOf(row, "return_mean");
    if (!HasStatus(row, ExperimentRunStatus::kFinished) || !return_mean) continue;
    figures.Add(NumberOf(row, "success"), row.at("episodes").get<size_t>(), *return_mean,
                NumberOf(row, "final_distance_mean"));
  }
  return figures;
}

std::vector<TargetReached> RowTargets(const ordered_json& arm) {
  std::vector<TargetReached> targets;
  for (const ordered_json& row : arm.at("runs")) {
    const bool over = HasStatus(row, ExperimentRunStatus::kFinished) ||
                      HasStatus(row, ExperimentRunStatus::kFailed);
    targets.push_back({row.at("seed").get<int64_t>(), over, NumberOf(row, "n_to_target")});
  }
  return targets;
}

SampleRatio RatioToFirst(const ordered_json& arms, size_t i) {
  return RatioOfEnded(RowTargets(arms.at(i)), RowTargets(arms.at(0)));
}

std::string NameOf(const ordered_json& arm) { return arm.at("name").get<std::string>(); }

// Adds the rule's name after target_success, where newer builds write it.
void NameFormerRule(ordered_json* summary) {
  ordered_json named;
  for (const auto& [key, value] : summary->items()) {
    named[key] = value;
    if (key == "target_success") named["n_to_target_rule"] = kReachedByEach;
  }
  *summary = std::move(named);
}

}  // namespace

bool HasStatus(const ordered_json& row, ExperimentRunStatus status) {
  return row.at("status").get<std::string>() == ToString(status);
}

void ComputeAggregates(ordered_json* summary) {
  if (!summary->contains("n_to_target_rule")) NameFormerRule(summary);
  ordered_json& arms = summary->at("arms");
  for (ordered_json& arm : arms) SetAggregates(RowFigures(arm), &arm);
  ordered_json ratios = ordered_json::array();
  if (!summary->at("ratios").empty()) {  // a task without success has no ratios
    for (size_t i = 1; i < arms.size(); ++i) {
      ratios.push_back(
          RatioJson(NameOf(arms.at(i)) + "/" + NameOf(arms.at(0)), RatioToFirst(arms, i)));
    }
  }
  (*summary)["ratios"] = ratios;
  const FramesResults frames = ReadFramesResults(*summary);
  if (!frames.frames.empty()) SetFramesAggregates(frames, summary);
}

ordered_json ReadStoredSummary(const std::filesystem::path& file) {
  auto summary = ParseBoundedJson<ordered_json>(ReadFile(file));
  if (!summary.is_object() || summary.value("schema", "") != kSummarySchema) {
    throw UsageError("'{}': expected a summary of schema {}", file.string(), kSummarySchema);
  }
  try {
    ComputeAggregates(&summary);
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("{}: {}", file.string(), e.what());
  }
  return summary;
}

std::string StoredSummaryText(const ordered_json& summary) {
  const ordered_json& arms = summary.at("arms");
  std::string text =
      fmt::format("experiment {}\n{}\n", NameOf(summary), summary.value("question", std::string()));
  std::vector<ArmRow> rows;
  for (const ordered_json& arm : arms) {
    rows.push_back({NameOf(arm), RowFigures(arm), arm.at("runs").size()});
  }
  text += ArmTable(rows) + FramesText(ReadFramesResults(summary));
  for (size_t i = 1; i < arms.size() && !summary.at("ratios").empty(); ++i) {
    const SampleRatio ratio = RatioToFirst(arms, i);
    const std::string arm = NameOf(arms.at(i)), first = NameOf(arms.at(0));
    text += fmt::format("env steps to {:.0f} %, {} / {}: {}",
                        100 * summary.at("target_success").get<double>(), arm, first,
                        FormatMedian(ratio));
    if (!ratio.pairs.empty()) text += fmt::format(" ({})", FormatPairs(ratio, arm, first));
    text += "\n";
  }
  return text;
}

}  // namespace shoal::launch
