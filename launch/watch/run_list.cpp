// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/json_fields.h"
#include "launch/record/run_folder.h"
#include "launch/watch/progress.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

RunStatus StatusOfExit(const std::string& exit) {
  if (exit == "target" || exit == "budget") return RunStatus::kFinished;
  if (exit == "interrupted") return RunStatus::kInterrupted;
  return exit == "failed" ? RunStatus::kFailed : RunStatus::kDead;
}

void ReadMeta(const std::filesystem::path& run, RunListing* listing) {
  const std::filesystem::path path = run / kMetaFile;
  if (!std::filesystem::exists(path)) return;  // not written yet, or ended before
  const json meta = ParseStrictJson(ReadFile(path), path);
  listing->preset = TextOrEmpty(meta, "preset");
  listing->task = TextOrEmpty(meta, "task");
  listing->started = TextOrEmpty(meta, "started");
  listing->problem = TextOrEmpty(meta, "error");
  meta.at("env_steps").get_to(listing->env_steps);
  meta.at("updates").get_to(listing->updates);
  meta.at("wall_seconds").get_to(listing->wall_seconds);
  if (const json& best = meta.at("best"); best.is_object()) {
    listing->best = {NumberOrNothing(best.at("success_rate")),
                     NumberOrNothing(best.at("return_mean"))};
  }
  listing->final = {NumberOrNothing(meta.at("final_success_rate")),
                    NumberOrNothing(meta.value("final_return_mean", json()))};
  listing->status = StatusOfExit(meta.at("exit").get<std::string>());
  // The end of the run was decided, but its coordinator died before completing the end.
  if (meta.value("finished", json()).is_null()) listing->status = RunStatus::kDead;
}

std::string Format(const RunScore& score) {
  if (score.success) return fmt::format("{:.0f} %", 100 * *score.success);
  return score.mean_return ? fmt::format("return {:.1f}", *score.mean_return) : "-";
}

// "2026-11-21 10:26" of "2026-11-21T10:26:48Z".
std::string ToTheMinute(std::string time) {
  if (time.empty()) return "-";
  std::ranges::replace(time, 'T', ' ');
  return time.substr(0, 16);
}

// Empty if the run's address is not written yet or cannot be read.
std::string PeerOf(const std::filesystem::path& run) try {
  const ClusterAddress address = ReadClusterAddress(run);
  return fmt::format("{}:{}", address.host, dds::OperatePort(address));
} catch (const Error&) {
  return "";
}

using RunRow = std::array<std::string, 9>;

std::string RenderedRow(const RunRow& row,
                        const std::array<size_t, std::tuple_size_v<RunRow>>& widths) {
  std::string line;
  for (size_t i = 0; i < row.size(); ++i) {
    const bool number = i >= 2 && i <= 7;
    line += number ? fmt::format("{:>{}}  ", row[i], widths[i])
                   : fmt::format("{:<{}}  ", row[i], widths[i]);
  }
  return line.substr(0, line.find_last_not_of(' ') + 1);
}

}  // namespace

const char* ToString(RunStatus status) {
  switch (status) {
    case RunStatus::kRunning:
      return "running";
    case RunStatus::kFinished:
      return "finished";
    case RunStatus::kInterrupted:
      return "interrupted";
    case RunStatus::kFailed:
      return "failed";
    case RunStatus::kDead:
      return "dead";
    case RunStatus::kUnreadable:
      return "unreadable";
  }
  return "?";
}

RunListing RunStatusOf(const std::filesystem::path& run) {
  RunListing listing;
  listing.name = run.filename().string();
  if (IsForbidden(run)) {
    listing.status = RunStatus::kUnreadable;
    listing.problem = "permission denied";
    return listing;
  }
  try {
    ReadMeta(run, &listing);
  } catch (const Error& e) {
    listing.status = RunStatus::kUnreadable;
    listing.problem = e.what();
  } catch (const json::exception& e) {
    listing.status = RunStatus::kUnreadable;
    listing.problem = fmt::format("{}: {}", (run / kMetaFile).string(), e.what());
  }
  if (IsHeld(run)) {
    listing.status = RunStatus::kRunning;
    listing.peer = PeerOf(run);
  }
  return listing;
}

std::vector<RunListing> ListRunStatus(const std::filesystem::path& dir) {
  std::vector<RunListing> runs;
  for (const std::filesystem::path& run : ListRuns(dir)) {
    runs.push_back(RunStatusOf(run));
    runs.back().size = SizeOfRun(run);
  }
  return runs;
}

std::vector<std::string> FormatRunList(const std::vector<RunListing>& runs) {
  std::vector<RunRow> rows{
      {"RUN", "STATUS", "ENV STEPS", "UPDATES", "BEST", "FINAL", "WALL", "SIZE", "STARTED (UTC)"}};
  for (const RunListing& run : runs) {
    rows.push_back({run.name, ToString(run.status), std::to_string(run.env_steps),
                    std::to_string(run.updates), Format(run.best), Format(run.final),
                    FormatDuration(run.wall_seconds), run.size ? FormatBytes(run.size->total) : "-",
                    ToTheMinute(run.started)});
  }
  std::array<size_t, std::tuple_size_v<RunRow>> widths{};
  for (const RunRow& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::vector<std::string> lines{RenderedRow(rows[0], widths)};
  for (size_t i = 0; i < runs.size(); ++i) {
    lines.push_back(RenderedRow(rows[i + 1], widths));
    if (!runs[i].problem.empty()) lines.push_back("  " + runs[i].problem);
  }
  return lines;
}

std::string RunListJson(const std::filesystem::path& dir, const std::vector<RunListing>& runs) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
  };
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
  };
  ordered_json list = ordered_json::array();
  for (const RunListing& run : runs) {
    list.push_back(
        {{"name", run.name},
         {"status", ToString(run.status)},
         {"preset", text_or_null(run.preset)},
         {"task", text_or_null(run.task)},
         {"env_steps", run.env_steps},
         {"updates", run.updates},
         {"best_success_rate", or_null(run.best.success)},
         {"best_return_mean", or_null(run.best.mean_return)},
         {"final_success_rate", or_null(run.final.success)},
         {"final_return_mean", or_null(run.final.mean_return)},
         {"wall_seconds", run.wall_seconds},
         {"disk_bytes", run.size ? ordered_json(run.size->total) : ordered_json(nullptr)},
         {"replay_bytes", run.size ? ordered_json(run.size->replay) : ordered_json(nullptr)},
         {"started", text_or_null(run.started)},
         {"peer", text_or_null(run.peer)},
         {"problem", text_or_null(run.problem)}});
  }
  const ordered_json object{{"schema", "shoal-runs-1"}, {"run_dir", dir.string()}, {"runs", list}};
  // Invalid UTF-8 in names of folders and contents of files is replaced.
  return object.dump(2, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
}

}  // namespace shoal::launch
