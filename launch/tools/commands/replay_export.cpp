// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "common/base/error.h"
#include "common/run_folder/run_file_names.h"
#include "launch/commands/run_with_replay.h"
#include "launch/commands/target_options.h"
#include "launch/record/run_folder.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/dataset/export_episodes.h"
#include "launch/tools/dataset/minari_metadata.h"
#include "replay_server/core/peek.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct EpisodesOptions {
  std::string source, run_dir = "runs", output;
  uint64_t episodes = 0;
  bool last = false;
};

// A ring belongs to the run of its folder, whose configuration describes the records.
EpisodeExport ExportSubject(const EpisodesOptions& options) {
  std::error_code error;
  const bool is_ring = fs::is_regular_file(options.source, error);
  const fs::path run = is_ring ? fs::absolute(options.source).parent_path()
                               : FindNamed(options.source, RunsIn(options.run_dir));
  EpisodeExport subject{.run = ReadRunWithReplay(run),
                        .ring = is_ring ? fs::path(options.source) : run / kRingFile,
                        .output = options.output,
                        .episodes = options.episodes,
                        .last = options.last};
  if (!is_ring && subject.run.config.replay.storage != "file") {
    throw UsageError("the run in '{}' keeps its replay in memory (replay.storage): no episodes",
                     run.string());
  }
  replay::CheckRingIsThere(subject.ring);
  return subject;
}

int RunExport(const EpisodesOptions& options) {
  const EpisodeExport subject = ExportSubject(options);
  const ExportedEpisodes exported = ExportEpisodes(subject);
  fmt::print("{}: {} episodes, {} steps of {} ({:.2f} MB)\n", options.output, exported.episodes,
             exported.steps, subject.run.spec.task, 1e-6 * static_cast<double>(exported.bytes));
  fmt::print("  left out: {} partly overwritten, {} without an end\n", exported.overwritten,
             exported.unended);
  const fs::path folder = fs::absolute(subject.output).lexically_normal().parent_path();
  if (subject.output.filename() == kMinariData) {
    fmt::print("  for minari.MinariDataset(\"{}\")\n", folder.string());
  } else {
    fmt::print("  {} beside it; Minari would look for the episodes in {}\n", kMinariMetadata,
               kMinariData);
  }
  return 0;
}

}  // namespace

void AddReplayExportCommand(CLI::App& replay, Action* chosen) {
  CLI::App* command = replay.add_subcommand(
      "export",
      "Write whole episodes as a dataset that Minari loads: an HDF5 file and metadata.json beside "
      "it.");
  const auto options = std::make_shared<EpisodesOptions>();
  AddRunOption(*command, &options->source, &options->run_dir,
               "Run: name or folder; or its replay.ring")
      ->required();
  command
      ->add_option("--output", options->output, "HDF5 file to write; Minari wants main_data.hdf5")
      ->required();
  CLI::Option* episodes =
      command
          ->add_option("--episodes", options->episodes, "Largest number of episodes; default: all")
          ->check(CLI::PositiveNumber);
  command->add_flag("--last", options->last, "Export the episodes that ended last instead of first")
      ->needs(episodes);
  command->callback([=] { *chosen = [=] { return RunExport(*options); }; });
}

}  // namespace shoal::launch
