// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/card.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/run_results.h"
#include "launch/tools/experiment/seed_figures.h"
#include "launch/tools/experiment/statistics_json.h"
#include "launch/tools/report/command_line.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string RewardText(const EvaluationFigures& final) {
  return fmt::format("{:.2f} +/- {:.2f}", final.return_mean, final.return_std);
}

// Uses the member names that leaderboards expect.
ordered_json ResultsJson(const RunResults& run) {
  const EvaluationFigures& final = *run.final;
  ordered_json object{{"env_id", run.config.task},
                      {"mean_reward", final.return_mean},
                      {"std_reward", final.return_std},
                      {"is_deterministic", true},
                      {"n_eval_episodes", final.episodes},
                      {"eval_datetime", run.finished},
                      {"n_training_timesteps", run.env_steps}};
  object["success_rate"] = final.success ? ordered_json(*final.success) : ordered_json(nullptr);
  return object;
}

std::string Metadata(const RunResults& run) {
  const std::string& task = run.config.task;
  std::string text = fmt::format(
      "---\nlibrary_name: shoal\ntags:\n- reinforcement-learning\n- deep-reinforcement-learning\n"
      "- robotics\n- {0}\nmodel-index:\n- name: {1}\n  results:\n  - task:\n      type: "
      "reinforcement-learning\n      name: reinforcement-learning\n    dataset:\n      name: {0}\n"
      "      type: {0}\n    metrics:\n    - type: mean_reward\n      value: {2}\n      name: "
      "mean_reward\n      verified: false\n",
      task, run.name, RewardText(*run.final));
  if (run.final->success) {
    text += fmt::format(
        "    - type: success_rate\n      value: {:.4f}\n      name: success_rate\n      verified: "
        "false\n",
        *run.final->success);
  }
  return text + "---\n";
}

std::string Readme(const RunResults& run, bool film) {
  const EvaluationFigures& final = *run.final;
  SeedFigures figures;
  figures.Add(final.success, final.episodes, final.return_mean, final.final_distance_mean);
  std::string text = Metadata(run);
  text += fmt::format("\n# {} on {}\n\n", run.name, run.config.task);
  text += fmt::format(
      "Trained with Shoal (build {}): {} env steps, {} updates, {:.0f} s on {}.\n\n",
      fmt::join(run.commits, ", "), run.env_steps, run.updates, run.wall_seconds, run.cpu);
  text += fmt::format(
      "| episodes | success [95 %] | return | final distance, cm |\n"
      "| --- | --- | --- | --- |\n| {} | {} | {} | {} |\n\n",
      final.episodes, FormatSuccess(figures), RewardText(final),
      final.final_distance_mean ? fmt::format("{:.2f}", Centimetres(*final.final_distance_mean))
                                : "-");
  text += fmt::format(
      "Deterministic actions, fresh episodes. Files: `results.json` (the figures above), `{}` "
      "(every key of the run), `{}` (the policy's parameters), `{}` and `{}` (what acting by them "
      "needs)",
      kConfigFile, kPolicyFile, kDescriptionFile, kStateFile);
  text += film ? ", `replay.mp4`.\n" : ".\n";
  text +=
      "\nTo play it: `shoal eval FOLDER`, `shoal film FOLDER` or `shoal_rl.Policy(\"FOLDER\")`.\n";
  return text + fmt::format("\nTo train it again: `{}`.\n", TrainAgain(kConfigFile, run.name));
}

}  // namespace

void WriteCard(const fs::path& run_folder, const fs::path& folder) {
  const RunResults run = ReadRunResults(run_folder);
  if (!run.final) {
    throw UsageError("run '{}' has no final evaluation ({}/{}): a card shows it",
                     run_folder.string(), kEvaluationFolder, kFinalEvaluationFile);
  }
  const fs::path checkpoint = JudgedCheckpoint(run_folder);
  if (checkpoint.empty() || !fs::exists(checkpoint / kPolicyFile)) {
    throw UsageError("run '{}' has no checkpoint with a {}", run_folder.string(), kPolicyFile);
  }
  const fs::path target = NamedFolder(fs::absolute(folder)), fresh = target.string() + ".tmp";
  if (fs::exists(target)) throw UsageError("'{}' exists: not overwritten", target.string());
  std::error_code error;
  fs::remove_all(fresh, error);
  MakeFolders(fresh);
  OpenToOthers(fresh);
  try {
    const std::vector<fs::path> films = FilmsOf(run_folder);  // the card contains the first one
    WriteFileForOthers(fresh / "README.md", Readme(run, !films.empty()));
    WriteFileForOthers(fresh / "results.json", ResultsJson(run).dump(2) + "\n");
    WriteFileForOthers(fresh / kConfigFile, ReadFile(run_folder / kConfigFile));
    for (const char* file : {kPolicyFile, kDescriptionFile, kStateFile}) {
      // Checkpoints of older builds have no policy.json.
      if (fs::exists(checkpoint / file)) {
        WriteFileForOthers(fresh / file, ReadFile(checkpoint / file));
      }
    }
    if (!films.empty()) WriteFileForOthers(fresh / "replay.mp4", ReadFile(films[0]));
    fs::rename(fresh, target, error);
    if (error) throw RuntimeError("cannot write '{}': {}", target.string(), error.message());
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(fresh, ignored);
    throw;
  }
}

}  // namespace shoal::launch
