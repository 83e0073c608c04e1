// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_end.h"

#include <fmt/core.h>

#include "actor/sending/made_page.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/config/on_policy.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "launch/film/film.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/run_hosts.h"
#include "launch/processes/run_leftovers.h"
#include "launch/record/accounting.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// Empty when no record was ever made.
std::optional<Accounting> AccountRun(const fs::path& run, const Config& config, uint64_t resends) {
  std::vector<MadeRecords> made;
  for (const actor::MadeCount& page : actor::ReadMadePages(run)) {
    made.push_back({page.actor, page.session, page.made});
  }
  if (made.empty() && !fs::exists(run / kAccountingFile)) return std::nullopt;
  return Account(made, ReadAccount(run),
                 {.resends = resends,
                  .own_actors = static_cast<uint32_t>(ActorsHere(run, config)),
                  .outlives_replay = !LearnsOnPolicy(config) && config.replay.storage == "file"});
}

// Whoever asked for a stop wants the terminal back; a run that has ended by itself is judged.
bool WantsFinalEvaluation(const RunMeta& meta) {
  return meta.exit != "interrupted" && !StopRequested();
}

std::optional<EvaluationPoint> EvaluateAtEnd(const fs::path& run, const Config& config,
                                             OperatorDesk& desk, Progress& progress) {
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (config.eval.final_episodes == 0 || checkpoint.empty()) return std::nullopt;
  progress.Say(fmt::format("evaluating {} on {} fresh episodes; Ctrl-C to leave it out",
                           checkpoint.string(), config.eval.final_episodes));
  auto point = EvaluateByActor({.run = run,
                                .checkpoint = checkpoint,
                                .episodes = config.eval.final_episodes,
                                .seed = config.seed,
                                .json = run / kEvaluationFolder / kFinalEvaluationFile,
                                .own_run = true},
                               [&desk] {
                                 desk.ShowAgain("evaluating", Now());
                                 return StopRequested();  // by the end of the terminal, too
                               });
  if (!point) progress.Say("the evaluation was left out");
  return point;
}

// Of the first of the episodes that judge the run. Empty when it was left out.
fs::path FilmAtEnd(const fs::path& run, const Config& config, OperatorDesk& desk,
                   Progress& progress) {
  constexpr int kEpisodes = 5;
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (checkpoint.empty()) throw RuntimeError("run '{}' has no checkpoint", run.string());
  const fs::path film = FilmPath(run, checkpoint.filename());
  const auto made = MakeFilm(
      {.run = run,
       .checkpoints = {checkpoint},
       .episodes = kEpisodes,
       .seed = config.seed,
       .output = film},
      [&desk] {
        desk.ShowAgain("evaluating", Now());
        return StopRequested();  // by the end of the terminal, too
      },
      [&](const std::string& line) { progress.Say(line); });
  if (made) return film;
  progress.Say("the film was left out");
  return {};
}

// A film wants a checkpoint, curves and a page an evaluation.
void PrintWhatToLookAt(const fs::path& run, bool filmed, Progress& progress) {
  std::string commands;
  if (!fs::is_empty(run / kEvaluationFolder)) {
    commands += fmt::format("; curves: shoal plot {0}; page: shoal report {0}", run.string());
  }
  if (!filmed && !NewestCheckpoint(run).empty()) {
    commands += fmt::format("; film: shoal film {}", run.string());
  }
  if (!commands.empty()) progress.Say("  " + commands.substr(2));
}

// `film` is empty where there is none.
void PrintSummary(const fs::path& run, const Config& config, const RunResult& result,
                  const std::optional<EvaluationPoint>& final_evaluation, const fs::path& film,
                  Progress& progress) {
  const RunMeta& meta = result.meta;
  progress.Say(fmt::format("run {} ended ({}): {} env steps, {} updates, {} ({:.0f} s)",
                           run.string(), meta.exit, meta.env_steps, meta.updates,
                           FormatDuration(meta.wall_seconds), meta.wall_seconds));
  if (final_evaluation) {
    progress.Say(fmt::format("  final evaluation: {} ({})", FormatScore(*final_evaluation),
                             (run / kEvaluationFolder / kFinalEvaluationFile).string()));
  }
  if (const std::string line = FormatFirstSuccess(meta, config.stop.evaluations); !line.empty()) {
    progress.Say("  " + line);
  }
  if (meta.exit == "interrupted") {
    progress.Say(
        fmt::format("  not evaluated: go on with shoal train --resume {0}, or judge it with shoal "
                    "eval --checkpoint {0}/checkpoints/NAME",
                    run.string()));
  }
  if (meta.accounting) progress.Say("  " + meta.accounting->Line());
  if (meta.updates_lost > 0) {
    progress.Say(fmt::format("  updates lost with a learner: {}", meta.updates_lost));
  }
  for (const std::string& line : FormatBottleneck(result.bottleneck)) progress.Say("  " + line);
  for (const char* name : {kMetaFile, kBottleneckFile, kMetricsFile, kEvaluationFolder,
                           kCheckpointFolder, kTensorBoardFolder}) {
    if (fs::exists(run / name)) progress.Say(fmt::format("  {}", (run / name).string()));
  }
  if (!film.empty()) progress.Say(fmt::format("  {}", film.string()));
  PrintWhatToLookAt(run, !film.empty(), progress);
}

}  // namespace

int EndRun(const fs::path& run, const Config& config, RunResult result, bool film,
           OperatorDesk& desk, Progress& progress) {
  RunMeta& meta = result.meta;
  bool good = result.clean && meta.exit != "failed";
  RemoveUnfinishedFiles(run);
  const auto fail = [&](const std::string& why) {
    good = false;
    if (meta.error.empty()) meta.error = why;
    progress.Say("error: " + why);
  };
  try {
    meta.accounting = AccountRun(run, config, meta.resends);
    if (meta.accounting) {
      for (const std::string& fault : meta.accounting->faults) {
        fail("records do not balance: " + fault);
      }
    }
  } catch (const Error& e) {
    fail(fmt::format("records cannot be accounted for: {}", e.what()));
  }
  std::optional<EvaluationPoint> final_evaluation;
  try {
    meta.updates_lost = ReadLostUpdates(run);
    WriteBottleneck(run, result.bottleneck);
    if (WantsFinalEvaluation(meta)) final_evaluation = EvaluateAtEnd(run, config, desk, progress);
    if (final_evaluation) {
      meta.final_success = final_evaluation->success;
      meta.final_return = final_evaluation->mean_return;
    }
  } catch (const Error& e) {
    fail(e.what());
  }
  meta.finished = UtcTimestamp();
  WriteRunMeta(run, config, meta);
  fs::path filmed;
  try {
    if (film && WantsFinalEvaluation(meta)) filmed = FilmAtEnd(run, config, desk, progress);
  } catch (const Error& e) {
    good = false;  // what was asked for is not there; the run itself is none the worse
    progress.Say(fmt::format("error: no film: {}", e.what()));
  }
  PrintSummary(run, config, result, final_evaluation, filmed, progress);
  if (!good) return 1;
  return meta.exit == "interrupted" && StopRequested() ? kInterruptedExit : 0;
}

}  // namespace shoal::launch
