#include "launch/run_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "launch/progress.h"
#include "launch/run_folder.h"
#include "launch/run_target.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

RunStatus StatusOfExit(const std::string& exit) {
  if (exit == "target" || exit == "budget") return RunStatus::kFinished;
  if (exit == "interrupted") return RunStatus::kInterrupted;
  return exit == "failed" ? RunStatus::kFailed : RunStatus::kDead;
}

std::string TextOrEmpty(const json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_string() ? it->get<std::string>() : "";
}

void ReadMeta(const std::filesystem::path& run, RunListing* listing) {
  const std::filesystem::path path = run / "meta.json";
  if (!std::filesystem::exists(path)) return;  // it ended, or has not come, before the first one
  const json meta = ParseStrictJson(ReadFile(path), path);
  listing->preset = TextOrEmpty(meta, "preset");
  listing->task = TextOrEmpty(meta, "task");
  listing->started = TextOrEmpty(meta, "started");
  listing->problem = TextOrEmpty(meta, "error");
  meta.at("env_steps").get_to(listing->env_steps);
  meta.at("updates").get_to(listing->updates);
  meta.at("wall_seconds").get_to(listing->wall_seconds);
  if (const json& best = meta.at("best"); best.is_object()) {
    // Null for a task that knows no success.
    if (const json& rate = best.at("success_rate"); !rate.is_null()) {
      listing->best_success = rate.get<double>();
    }
  }
  if (const json& last = meta.at("final_success_rate"); last.is_number()) {
    listing->final_success = last.get<double>();
  }
  listing->status = StatusOfExit(meta.at("exit").get<std::string>());
}

RunListing List(const std::filesystem::path& run) {
  RunListing listing;
  listing.name = run.filename().string();
  try {
    ReadMeta(run, &listing);
  } catch (const Error& e) {
    listing.status = RunStatus::kUnreadable;
    listing.problem = e.what();
  } catch (const json::exception& e) {
    listing.status = RunStatus::kUnreadable;
    listing.problem = fmt::format("{}: {}", (run / "meta.json").string(), e.what());
  }
  if (IsHeld(run)) listing.status = RunStatus::kRunning;
  return listing;
}

std::string Percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.0f} %", 100 * *share) : "-";
}

using Row = std::array<std::string, 9>;

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

std::vector<RunListing> ListRunStatus(const std::filesystem::path& dir) {
  std::vector<RunListing> runs;
  for (const std::filesystem::path& run : ListRuns(dir)) runs.push_back(List(run));
  return runs;
}

std::vector<std::string> FormatRunList(const std::vector<RunListing>& runs) {
  std::vector<Row> rows{
      {"RUN", "STATUS", "ENV STEPS", "UPDATES", "BEST", "FINAL", "WALL", "STARTED", "PROBLEM"}};
  for (const RunListing& run : runs) {
    rows.push_back({run.name, ToString(run.status), std::to_string(run.env_steps),
                    std::to_string(run.updates), Percent(run.best_success),
                    Percent(run.final_success), FormatDuration(run.wall_seconds),
                    run.started.empty() ? "-" : run.started, run.problem});
  }
  std::array<size_t, 9> widths{};
  for (const Row& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    std::string line;
    for (size_t i = 0; i + 1 < row.size(); ++i) {
      const bool number = i >= 2 && i <= 6;
      line += number ? fmt::format("{:>{}}  ", row[i], widths[i])
                     : fmt::format("{:<{}}  ", row[i], widths[i]);
    }
    line += row.back();
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
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
    list.push_back({{"name", run.name},
                    {"status", ToString(run.status)},
                    {"preset", text_or_null(run.preset)},
                    {"task", text_or_null(run.task)},
                    {"env_steps", run.env_steps},
                    {"updates", run.updates},
                    {"best_success_rate", or_null(run.best_success)},
                    {"final_success_rate", or_null(run.final_success)},
                    {"wall_seconds", run.wall_seconds},
                    {"started", text_or_null(run.started)},
                    {"problem", text_or_null(run.problem)}});
  }
  const ordered_json object{{"schema", "shoal-runs-1"}, {"run_dir", dir.string()}, {"runs", list}};
  return object.dump(2);
}

}  // namespace shoal::launch
