// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_content.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "launch/record/run_folder.h"
#include "launch/tools/web/page_answers.h"
#include "launch/tools/web/served_file.h"
#include "launch/watch/run_list.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostCurves = 8;            // runs; the least recently requested is dropped
constexpr std::chrono::seconds kRunsFor{2};  // how long an answer about all runs is reused

}  // namespace

std::vector<fs::path> PageContent::Folders() const {
  if (!options_.run.empty()) return {options_.run};
  return ListRuns(options_.run_dir);
}

std::optional<fs::path> PageContent::FindRun(const std::string& name) const {
  for (const fs::path& run : Folders()) {
    if (run.filename().string() == name) return run;
  }
  return std::nullopt;
}

std::string PageContent::Runs() {
  const MutexLock lock(runs_mutex_);
  if (runs_.empty() || Now() - runs_of_ > kRunsFor) {
    std::vector<RunListing> runs;
    for (const fs::path& run : Folders()) runs.push_back(RunStatusOf(run));
    runs_ = RunsAnswer(options_.run_dir, runs);
    runs_of_ = Now();
  }
  return runs_;
}

std::string PageContent::Run(const fs::path& run) const {
  return RunAnswer(NewestCheckpoint(run).filename().string(), ListServedFiles(run),
                   episodes_.Of(run));
}

std::string PageContent::Top(const fs::path& run) { return TopAnswer(live_.View(run)); }

std::string PageContent::Curves(const fs::path& run) {
  const MutexLock lock(curves_mutex_);
  auto it = curves_.find(run);
  if (it == curves_.end()) {
    if (curves_.size() >= kMostCurves) {
      curves_.erase(std::ranges::min_element(curves_, {},
                                             [](const auto& entry) { return entry.second.asked; }));
    }
    it = curves_.emplace(run, CurvesOf{RunCurves(run), {}}).first;
  }
  it->second.asked = Now();
  it->second.curves.ReadOn();
  return it->second.curves.Json();
}

std::string PageContent::Carry(const fs::path& run, const std::string& body) {
  const PageOrder order = ParsePageOrder(body);
  const ReplyMessage reply = live_.Order(run, order.verb, order.arguments);
  return nlohmann::json{{"text", reply.text}}.dump(-1, ' ', /*ensure_ascii=*/false,
                                                   nlohmann::json::error_handler_t::replace);
}

std::string PageContent::Play(const fs::path& run) {
  episodes_.Play(run);
  return Run(run);
}

fs::path PageContent::EpisodeFilm(const fs::path& run) const { return episodes_.Of(run).film; }

}  // namespace shoal::launch
