// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "common/base/error.h"
#include "common/base/file_lock.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/run_folder/run_file_names.h"
#include "launch/commands/commands.h"
#include "launch/record/run_folder.h"
#include "launch/watch/run_list.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct CleanOptions {
  std::vector<std::string> runs;
  std::string run_dir = "runs";
  bool yes = false;
};

struct Replay {
  fs::path run;
  RunStatus status = RunStatus::kDead;
  uint64_t bytes = 0;
};

// Processes of a run can outlive its coordinator.
bool IsAlive(const fs::path& run) { return IsHeld(run) || AnyMember(run); }

// The replay of a run; empty if it has none.
std::optional<Replay> ReplayOf(const fs::path& run) {
  const uint64_t bytes = SizeOfRun(run).replay;
  if (bytes == 0) return std::nullopt;
  return Replay{run, RunStatusOf(run).status, bytes};
}

// The replays that may be removed: those of finished runs without replay.keep.
std::vector<Replay> FindReplays(const fs::path& dir) {
  std::vector<Replay> found;
  for (const fs::path& run : ListRuns(dir)) {
    const auto replay = ReplayOf(run);
    if (!replay || replay->status != RunStatus::kFinished || IsAlive(run)) continue;
    try {
      if (!ReadRunConfig(run).config.replay.keep) found.push_back(*replay);
    } catch (const Error& e) {
      std::cerr << "left alone: " << e.what() << "\n";
    }
  }
  return found;
}

std::vector<Replay> NamedReplays(const CleanOptions& options) {
  std::vector<Replay> found;
  for (const std::string& name : options.runs) {
    const fs::path run = FindNamed(name, RunsIn(options.run_dir));
    if (IsAlive(run)) throw UsageError("run '{}' is running: nothing is removed", run.string());
    if (const auto replay = ReplayOf(run)) {
      found.push_back(*replay);
    } else {
      std::cout << (run / kRingFile).string() << " does not exist\n";
    }
  }
  return found;
}

void PrintReplays(const std::vector<Replay>& replays) {
  for (const Replay& replay : replays) {
    std::cout << "  " << (replay.run / kRingFile).string() << "  " << FormatBytes(replay.bytes)
              << "  of a run that is " << ToString(replay.status)
              << (replay.status == RunStatus::kFinished
                      ? ""
                      : ": --resume will start with an empty replay")
              << "\n";
  }
}

bool Agreed(size_t files, uint64_t bytes) {
  if (isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        "standard input is not a terminal, so the removal cannot be confirmed: give --yes to "
        "remove them");
  }
  std::cout << "remove " << files << " file(s), " << FormatBytes(bytes) << "? [y/N] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

// Locks the run during removal, so that it cannot be resumed. Returns false if the run is running.
bool Remove(const Replay& replay) {
  const auto lock = FileLock::Take(replay.run / kRunLockFile);
  if (!lock || AnyMember(replay.run)) return false;
  const fs::path file = replay.run / kRingFile;
  std::error_code error;
  fs::remove(file, error);
  if (error) throw RuntimeError("cannot remove '{}': {}", file.string(), error.message());
  return true;
}

int Clean(const CleanOptions& options) {
  const std::vector<Replay> replays =
      options.runs.empty() ? FindReplays(options.run_dir) : NamedReplays(options);
  if (replays.empty()) {
    std::cout << "nothing to remove\n";
    return 0;
  }
  uint64_t bytes = 0;
  for (const Replay& replay : replays) bytes += replay.bytes;
  PrintReplays(replays);
  if (!options.yes && !Agreed(replays.size(), bytes)) {
    std::cout << "nothing was removed\n";
    return 0;
  }
  uint64_t freed = 0;
  for (const Replay& replay : replays) {
    if (Remove(replay)) {
      freed += replay.bytes;
    } else {
      std::cout << "kept because the run is running now: " << replay.run.string() << "\n";
    }
  }
  std::cout << FormatBytes(freed) << " freed\n";
  return 0;
}

}  // namespace

void AddCleanCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "clean",
      "Remove the replays of finished runs, by far their largest files, after a confirmation.");
  const auto options = std::make_shared<CleanOptions>();
  command->add_option(
      "runs", options->runs,
      "Runs, by name or folder, finished or not; default: every finished run without replay.keep");
  command->add_option("--run-dir", options->run_dir, "Folder that holds the runs")
      ->capture_default_str();
  command->add_flag("--yes", options->yes, "Remove without a confirmation");
  command->callback([=] { *chosen = [=] { return Clean(*options); }; });
}

}  // namespace shoal::launch
