// SPDX-License-Identifier: Apache-2.0
// Writes the folder of a finished run without running its programs.
#pragma once

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {

// One evaluation of schema shoal-eval-1 with these means. If `success` is empty, the task has no
// success.
inline nlohmann::ordered_json PlantedEvaluation(uint64_t env_steps, std::optional<double> success,
                                                int episodes, double return_mean = -1) {
  return {{"schema", "shoal-eval-1"},
          {"task", "FetchReachDense"},
          {"checkpoint", "best"},
          {"weights_version", {{"session", 1}, {"update", env_steps / 10}}},
          {"env_steps", env_steps},
          {"wall_seconds", static_cast<double>(env_steps) / 100},
          {"episodes", std::vector<int>(static_cast<size_t>(episodes), 0)},
          {"aggregate",
           {{"success_rate", success ? nlohmann::ordered_json(*success) : nlohmann::ordered_json()},
            {"return_mean", return_mean},
            {"return_std", 0.1},
            {"length_mean", 50.0},
            {"final_distance_mean", 0.02}}}};
}

// Writes files of a run into `path`, which is created if missing.
class RunPlanter {
 public:
  explicit RunPlanter(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }

  void Begin(const std::vector<std::string>& keys = {}) const {
    MakeFolders(path_ / "eval");
    RunConfig run;
    ApplyAssignments(keys, &run.config);
    WriteRunConfig(path_, run);
  }
  void WriteMeta(const std::string& exit, const std::string& error = "") const {
    nlohmann::ordered_json meta{{"schema", "shoal-run-1"},
                                {"exit", exit},
                                {"env_steps", 1000},
                                {"updates", 100},
                                {"wall_seconds", 360.0},
                                {"cpu_seconds", 712.4},
                                {"energy_wh", 1.234},
                                {"commits", {"abc", "def"}},
                                {"machine", {{"cpu", "a fast one"}, {"cores", 2}}}};
    meta["error"] = error.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(error);
    WriteFileAtomically(path_ / "meta.json", meta.dump());
  }
  void WriteFinal(std::optional<double> success, int episodes, double return_mean = -1) const {
    WriteFileAtomically(path_ / "eval/final.json",
                        PlantedEvaluation(1000, success, episodes, return_mean).dump());
  }
  void WriteEvaluation(uint64_t env_steps, double success, double return_mean = -1) const {
    WriteFileAtomically(path_ / fmt::format("eval/steps_{:010}.json", env_steps),
                        PlantedEvaluation(env_steps, success, 50, return_mean).dump());
  }

 private:
  std::filesystem::path path_;
};

// A run in a temporary folder.
class PlantedRun {
 public:
  std::filesystem::path path() const { return planter_.path(); }
  void Begin() const { planter_.Begin(); }
  void WriteMeta(const std::string& exit, const std::string& error = "") const {
    planter_.WriteMeta(exit, error);
  }
  void WriteFinal(double success, int episodes) const { planter_.WriteFinal(success, episodes); }

 private:
  TemporaryFolder folder_;
  RunPlanter planter_{folder_.path() / "run"};
};

}  // namespace shoal::launch
