// SPDX-License-Identifier: Apache-2.0
// Computes the answers to the page's requests: list of runs, curves, connections to running runs,
// played episodes.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/mutex.h"
#include "launch/tools/web/live_runs.h"
#include "launch/tools/web/played_episode.h"
#include "launch/tools/web/run_curves.h"

namespace shoal::launch {

struct PageContentOptions {
  std::filesystem::path run{};  // folder of the only run shown; empty = all runs of run_dir
  std::filesystem::path run_dir = "runs";
  std::string secure{};
};

// Any thread. The answers are JSON (page_answers.h). All functions throw Error.
class PageContent {
 public:
  explicit PageContent(const PageContentOptions& options)
      : options_(options), live_(options.secure) {}

  // Folder of a run that the page shows; empty if there is no run of that name. The name is only
  // compared with the names of the runs; no path is built from the name.
  std::optional<std::filesystem::path> FindRun(const std::string& name) const;

  std::string Runs();
  std::string Run(const std::filesystem::path& run) const;
  std::string Top(const std::filesystem::path& run);
  std::string Curves(const std::filesystem::path& run);
  // Sends an order to a run (ParsePageOrder), and returns {"text": result}.
  std::string Carry(const std::filesystem::path& run, const std::string& body);
  std::string Play(const std::filesystem::path& run);

  // Film of the run's played episode; empty if there is no film.
  std::filesystem::path EpisodeFilm(const std::filesystem::path& run) const;
  void Tend() { live_.LeaveUnwatched(Now()); }

 private:
  struct CurvesOf {
    RunCurves curves;
    SteadyTime asked;
  };

  std::vector<std::filesystem::path> Folders() const;

  const PageContentOptions options_;
  LiveRuns live_;
  PlayedEpisodes episodes_;
  Mutex curves_mutex_;
  std::map<std::filesystem::path, CurvesOf> curves_ SHOAL_GUARDED_BY(curves_mutex_);
  Mutex runs_mutex_;
  std::string runs_ SHOAL_GUARDED_BY(runs_mutex_);  // last answer of Runs()
  SteadyTime runs_of_ SHOAL_GUARDED_BY(runs_mutex_){};
};

}  // namespace shoal::launch
