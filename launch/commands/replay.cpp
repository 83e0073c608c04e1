// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "common/base/error.h"
#include "common/config/on_policy.h"
#include "common/config/run_files.h"
#include "common/image/png.h"
#include "common/run_folder/run_file_names.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/record/run_folder.h"
#include "launch/tools/dataset/export_episodes.h"
#include "launch/tools/dataset/minari_metadata.h"
#include "replay_server/core/peek.h"
#include "replay_server/core/replay_core.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct PeekOptions {
  std::string run, run_dir = "runs", png;
  int batch = 8;
  uint64_t seed = 1;
};

RunConfig ReadRunWithReplay(const fs::path& run) {
  RunConfig config = ReadRunConfig(run);
  if (LearnsOnPolicy(config.config)) {
    throw UsageError("'{}' has no replay: learner.algorithm = {} learns from rollouts",
                     run.string(), config.config.learner.algorithm);
  }
  return config;
}

int Peek(const PeekOptions& options) {
  const fs::path run = FindNamed(options.run, RunsIn(options.run_dir));
  ReadRunWithReplay(run);
  const replay::Peek peek = replay::PeekBatch(run, options.batch, options.seed);
  std::cout << peek.records << " records in the ring, " << peek.sampleable
            << " steps can be sampled\n";
  for (const std::string& caption : peek.captions) std::cout << "  " << caption << "\n";
  if (options.png.empty()) return 0;
  if (peek.rgb.empty()) {
    std::cout << "no picture: the run observes no pixels\n";
    return 0;
  }
  image::WritePng(options.png, peek.width, peek.height, 3, peek.rgb);
  std::cout << options.png << ": one column per element; rows per camera: observation, shifted, "
            << "next observation, shifted\n";
  return 0;
}

struct EpisodesOptions {
  std::string source, run_dir = "runs", output;
  uint64_t episodes = 0;
  bool last = false;
};

// A ring belongs to the run in whose folder it lies: the run's configuration says what it holds.
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

void AddPeek(CLI::App* replay, Action* chosen) {
  CLI::App* command =
      replay->add_subcommand("peek", "Draw a batch as the learner would get it and show it.");
  const auto options = std::make_shared<PeekOptions>();
  AddRunOption(*command, &options->run, &options->run_dir)->required();
  ExpectPng(command->add_option("--png", options->png, "File for the batch as a picture"));
  command->add_option("--batch", options->batch, "Elements to draw")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of the draw")->capture_default_str();
  command->callback([=] { *chosen = [=] { return Peek(*options); }; });
}

void AddExport(CLI::App* replay, Action* chosen) {
  CLI::App* command = replay->add_subcommand(
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
      command->add_option("--episodes", options->episodes, "At most so many; else all")
          ->check(CLI::PositiveNumber);
  command->add_flag("--last", options->last, "Those that ended last, not those that ended first")
      ->needs(episodes);
  command->callback([=] { *chosen = [=] { return RunExport(*options); }; });
}

}  // namespace

void AddReplayCommand(CLI::App& app, Action* chosen) {
  CLI::App* replay = app.add_subcommand("replay", "Look into a run's replay, take episodes out.");
  replay->require_subcommand(1);
  AddPeek(replay, chosen);
  AddExport(replay, chosen);
}

}  // namespace shoal::launch
