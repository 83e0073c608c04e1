// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_end.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <set>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/base/write_faults.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/film_program.h"
#include "launch/processes/run_leftovers.h"
#include "launch/record/accounting.h"
#include "launch/record/run_folder.h"
#include "launch/record/run_size.h"
#include "launch/run/run_account.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// A stop skips the final evaluation, so that the command returns promptly. A run that ends by
// itself is evaluated.
bool WantsFinalEvaluation(const RunMeta& meta) {
  return meta.exit != "interrupted" && !StopRequested();
}

// Publishes views and answers commands while the run is evaluated and filmed.
class Judging {
 public:
  Judging(RunServer& server, Progress& progress) : server_(server), progress_(progress) {}

  // Whether to skip the rest: after a stop signal (also SIGHUP) or `shoal stop`. Called several
  // times per second.
  bool Stops() {
    server_.ShowAgain("evaluating", Now());
    for (const CommandMessage& command : server_.TakeCommands()) Answer(command);
    return stop_ || StopRequested();
  }
  void Say(const std::string& line) { progress_.Say(line); }

 private:
  void Answer(const CommandMessage& command) {
    ReplyMessage reply{.client = command.client, .request = command.request};
    reply.accepted = command.verb == "stop";
    reply.text = reply.accepted ? "training has ended; the rest of the evaluation is skipped"
                                : "training has ended and the run is being evaluated: its settings "
                                  "can no longer change";
    stop_ = stop_ || reply.accepted;
    Say(fmt::format("command: {}: {}{}", command.verb,
                    reply.accepted ? "" : "refused: ", reply.text));
    server_.Answer(reply);
  }

  RunServer& server_;
  Progress& progress_;
  bool stop_ = false;
};

std::optional<EvaluationPoint> EvaluateAtEnd(const fs::path& run, const Config& config,
                                             Judging& judging) {
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (config.eval.final_episodes == 0 || checkpoint.empty()) return std::nullopt;
  judging.Say(fmt::format("evaluating {} on {} fresh episodes; Ctrl-C skips the evaluation",
                          checkpoint.string(), config.eval.final_episodes));
  auto point = EvaluateByActor({.run = run,
                                .checkpoint = checkpoint,
                                .episodes = config.eval.final_episodes,
                                .seed = config.seed,
                                .json = run / kEvaluationFolder / kFinalEvaluationFile,
                                .own_run = true},
                               [&judging] { return judging.Stops(); });
  if (!point) judging.Say("the evaluation was skipped");
  return point;
}

// Films the first of the episodes that judge the run. Empty if `judging` stopped the film.
fs::path FilmAtEnd(const fs::path& run, const Config& config, Judging& judging) {
  constexpr int kEpisodes = 5;
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (checkpoint.empty()) throw RuntimeError("run '{}' has no checkpoint", run.string());
  const fs::path film = run / kVideoFolder / (checkpoint.filename().string() + ".mp4");
  const bool made = FilmByCommand(
      {.checkpoint = checkpoint, .episodes = kEpisodes, .seed = config.seed, .output = film},
      [&judging] { return judging.Stops(); },
      [&judging](const std::string& line) { judging.Say(line); });
  if (made) return film;
  judging.Say("the film was skipped");
  return {};
}

// Prints commands that work for this run: a film needs a checkpoint; curves and a page need an
// evaluation.
void PrintWhatToLookAt(const fs::path& run, bool filmed, Progress& progress) {
  std::string commands;
  std::error_code error;
  if (!fs::is_empty(run / kEvaluationFolder, error) && !error) {
    commands += fmt::format("; curves: shoal plot {0}; page: shoal report {0}", run.string());
  }
  if (!filmed && !NewestCheckpoint(run).empty()) {
    commands += fmt::format("; film: shoal film {}", run.string());
  }
  if (!commands.empty()) progress.Say("  " + commands.substr(2));
}

// "faulty episodes of the actors, ended where a number was not finite: 3 diverged, 1 observation".
std::string FaultyEpisodesText(const RunMeta& meta) {
  std::string counts;
  for (const auto& [cause, count] : meta.faulty_episodes) {
    counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, cause);
  }
  if (counts.empty()) return "";
  return fmt::format("faulty episodes of the actors, ended where a number was not finite: {}",
                     counts);
}

// `film` is empty if there is no film.
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
    progress.Say(fmt::format(
        "  not evaluated: continue with shoal train --resume {0}, or evaluate with shoal eval {0}",
        run.string()));
  }
  if (meta.accounting) progress.Say("  " + meta.accounting->Line());
  if (!result.deaths.empty()) progress.Say("  deaths: " + result.deaths);
  if (const std::string faulty = FaultyEpisodesText(meta); !faulty.empty()) {
    progress.Say("  " + faulty);
  }
  if (meta.updates_lost > 0) {
    progress.Say(fmt::format("  updates lost with a learner: {}", meta.updates_lost));
  }
  for (const std::string& line : FormatBottleneck(result.bottleneck)) progress.Say("  " + line);
  std::error_code error;
  for (const char* name : {kMetaFile, kBottleneckFile, kMetricsFile, kEvaluationFolder,
                           kCheckpointFolder, kTensorBoardFolder}) {
    if (fs::exists(run / name, error)) progress.Say(fmt::format("  {}", (run / name).string()));
  }
  if (!film.empty()) progress.Say(fmt::format("  {}", film.string()));
  PrintWhatToLookAt(run, !film.empty(), progress);
}

// Whether the run reached its target or budget.
bool Finished(const RunMeta& meta) { return meta.exit == "target" || meta.exit == "budget"; }

// A finished run does not need its replay, which is by far its largest file.
void RemoveRing(const fs::path& run, const Config& config, Progress& progress) {
  const fs::path ring = run / kRingFile;
  std::error_code error;
  const uintmax_t bytes = fs::file_size(ring, error);
  if (error || config.replay.keep || !fs::remove(ring, error)) return;
  progress.Say(fmt::format("  {} removed: {} free again (replay.keep = true keeps it)",
                           ring.string(), FormatBytes(bytes)));
}

// Reports files that could not be written. Returns the exit code.
int ReportUnwritten(const fs::path& run, const std::set<std::string>& unwritten,
                    Progress& progress) {
  progress.Say(
      fmt::format("error: not completely written: {}; training itself was not affected. Free disk "
                  "space, then: shoal train --resume {}",
                  fmt::join(unwritten, ", "), run.string()));
  return kUnwrittenExit;
}

using Fail = std::function<void(const std::string&)>;

void TakeAccount(const fs::path& run, const Config& config, const link::RunTopology& topology,
                 const std::set<std::string>& unwritten, Progress& progress, const Fail& fail,
                 RunMeta* meta) {
  try {
    // If a receiver could not write its last account, the file holds an older one.
    for (const link::RunProcess& receiver : topology.RecordReceivers()) {
      if (!unwritten.contains(receiver.Name().Text())) continue;
      throw RuntimeError("{} could not write {}", receiver.Name().Text(), kAccountingFile);
    }
    meta->accounting = AccountRun(run, config, topology, meta->resends);
    if (!meta->accounting) return;
    for (const std::string& fault : meta->accounting->faults) {
      fail("records do not balance: " + fault);
    }
  } catch (const Error& e) {
    const std::string why = fmt::format("records cannot be accounted for: {}", e.what());
    unwritten.empty() ? fail(why) : progress.Say(why);
  }
}

// Empty if the final evaluation was skipped or not configured.
std::optional<EvaluationPoint> Judge(const fs::path& run, const Config& config, Judging& judging,
                                     const Fail& fail, RunMeta* meta) {
  std::optional<EvaluationPoint> evaluation;
  try {
    meta->updates_lost = ReadLostUpdates(run);
    if (WantsFinalEvaluation(*meta)) evaluation = EvaluateAtEnd(run, config, judging);
  } catch (const Error& e) {
    fail(e.what());
  }
  if (evaluation) {
    meta->final_success = evaluation->success;
    meta->final_return = evaluation->mean_return;
  }
  return evaluation;
}

// Adds meta.json to `unwritten` or removes it, depending on this last attempt.
void WriteLastMeta(const fs::path& run, const Config& config, WriteFaults& faults,
                   std::set<std::string>* unwritten, RunMeta* meta) {
  meta->finished = UtcTimestamp();
  unwritten->erase(kMetaFile);
  if (!unwritten->empty() && meta->error.empty()) {
    meta->error = fmt::format("could not be written: {}", fmt::join(*unwritten, ", "));
  }
  if (!faults.Try(kMetaFile, [&] { WriteRunMeta(run, config, *meta); })) {
    unwritten->insert(kMetaFile);
  }
}

}  // namespace

int EndRun(const fs::path& run, const Config& config, const link::RunTopology& topology,
           RunResult result, bool film, RunServer& server, Progress& progress) {
  RunMeta& meta = result.meta;
  std::set<std::string>& unwritten = result.unwritten;
  bool good = result.clean && meta.exit != "failed";
  RemoveUnfinishedFiles(run);
  const Fail fail = [&](const std::string& why) {
    good = false;
    if (meta.error.empty()) meta.error = why;
    progress.Say("error: " + why);
  };
  TakeAccount(run, config, topology, unwritten, progress, fail, &meta);
  // `unwritten` makes it print a line if a file that failed earlier can be written now.
  WriteFaults faults([&](const std::string& line) { progress.Say(line); }, unwritten);
  if (!faults.Try(kBottleneckFile, [&] { WriteBottleneck(run, result.bottleneck); })) {
    unwritten.insert(kBottleneckFile);
  }
  if (!unwritten.empty() && Finished(meta)) meta.exit = "interrupted";  // --resume ends it
  Judging judging(server, progress);
  const auto final_evaluation = Judge(run, config, judging, fail, &meta);
  WriteLastMeta(run, config, faults, &unwritten, &meta);
  fs::path filmed;
  try {
    if (film && WantsFinalEvaluation(meta) && !judging.Stops()) {
      filmed = FilmAtEnd(run, config, judging);
    }
  } catch (const Error& e) {
    good = false;  // a missing film does not affect the run itself
    progress.Say(fmt::format("error: no film: {}", e.what()));
  }
  PrintSummary(run, config, result, final_evaluation, filmed, progress);
  if (!good) return 1;
  if (!unwritten.empty()) return ReportUnwritten(run, unwritten, progress);
  if (Finished(meta)) RemoveRing(run, config, progress);
  return StopRequested() ? kInterruptedExit : 0;
}

}  // namespace shoal::launch
