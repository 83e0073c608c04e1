// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "common/image/png.h"
#include "launch/commands/commands.h"
#include "launch/commands/run_with_replay.h"
#include "launch/commands/target_options.h"
#include "launch/record/run_folder.h"
#include "replay_server/core/peek.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct PeekOptions {
  std::string run, run_dir = "runs", png;
  int batch = 8;
  uint64_t seed = 1;
};

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

void AddPeek(CLI::App* replay, Action* chosen) {
  CLI::App* command =
      replay->add_subcommand("peek", "Draw a batch as the learner would get it and show it.");
  const auto options = std::make_shared<PeekOptions>();
  AddRunOption(*command, &options->run, &options->run_dir)->required();
  ExpectPng(command->add_option("--png", options->png, "File for the batch as a picture"));
  command->add_option("--batch", options->batch, "Elements to draw")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the draw")->capture_default_str();
  command->callback([=] { *chosen = [=] { return Peek(*options); }; });
}

}  // namespace

void AddReplayCommand(CLI::App& app, Action* chosen) {
  CLI::App* replay =
      app.add_subcommand("replay", "Show batches of a run's replay, or export its episodes.");
  replay->require_subcommand(1);
  AddPeek(replay, chosen);
}

}  // namespace shoal::launch
