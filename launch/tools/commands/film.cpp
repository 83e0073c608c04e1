// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/run_folder/run_file_names.h"
#include "common/tensorboard/event_writer.h"
#include "launch/commands/target_options.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/film/film_checkpoints.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct FilmOptions {
  CheckpointWords checkpoint;
  std::string output, quality;
  bool across = false, tensorboard = false;
  int episodes = 0;  // 0: kEpisodes, or kEpisodesAcross for each checkpoint
  int64_t seed = 1;
};

constexpr int kEpisodes = 5, kEpisodesAcross = 2;
constexpr uintmax_t kLargestInReport = 2'000'000;  // bytes

FilmOrder OrderOf(const FilmOptions& options) {
  FilmOrder order;
  const NamedCheckpoint named = FindCheckpoint(options.checkpoint);
  if (named.run.empty()) {
    throw UsageError("'{}' is neither a run nor RUN/checkpoints/NAME", named.checkpoint.string());
  }
  order.run = named.run;
  order.seed = options.seed;
  order.episodes = options.episodes;
  if (order.episodes == 0) order.episodes = options.across ? kEpisodesAcross : kEpisodes;
  if (options.across) {
    order.checkpoints = CheckpointsAcross(order.run);
  } else {
    order.checkpoints = {named.checkpoint};
  }
  order.quality = options.quality;
  order.output = options.output;
  if (options.output.empty()) {
    order.output =
        FilmPath(order.run, options.across ? "across" : order.checkpoints[0].filename().string());
  }
  CheckFilmOutput(order.run, order.output);
  order.strips = options.tensorboard;
  return order;
}

// Writes to a separate folder: TensorBoard follows the newest file of a folder, and the run's file
// may still grow.
void WriteStrips(const fs::path& run, const std::vector<CheckpointStrip>& strips) {
  tensorboard::EventWriter events(run / kTensorBoardFolder / "film");
  for (const CheckpointStrip& strip : strips) {
    events.Image("film/episode", static_cast<int64_t>(strip.env_steps), strip.image.width,
                 strip.image.height, strip.image.png);
  }
  events.Flush();
  fmt::print("{}\n", events.path().string());
}

int Film(const FilmOptions& options) {
  InstallStopSignals();
  const FilmOrder order = OrderOf(options);
  const auto film = MakeFilm(order, StopRequested,
                             [](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  if (!film) {
    fmt::print(stderr, "shoal: interrupted: no film was made\n");
    return kInterruptedExit;
  }
  fmt::print("{}: {:.1f} s, {} frames, {:.2f} MB\n", order.output.string(), film->seconds,
             film->frames, 1e-6 * static_cast<double>(film->bytes));
  if (options.tensorboard) WriteStrips(order.run, film->strips);
  if (film->bytes > kLargestInReport) {
    fmt::print(stderr, "reports leave out films above 2 MB: fewer --episodes make a smaller one\n");
  }
  return 0;
}

}  // namespace

void AddFilmCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "film",
      "Film a run's policy as MP4: its input, pixel by pixel, beside a larger view, with step, "
      "reward, return and success. The film plays in browsers, as fast as the robot moves.");
  const auto options = std::make_shared<FilmOptions>();
  CLI::Option* checkpoint = AddCheckpointOptions(*command, &options->checkpoint);
  auto* across =
      command->add_flag("--across-checkpoints", options->across,
                        "Film the first checkpoint, two between and the best, one after the other");
  checkpoint->excludes(across);
  command
      ->add_option("--episodes", options->episodes,
                   fmt::format("Episodes to play; default {}, {} of each checkpoint across them",
                               kEpisodes, kEpisodesAcross))
      ->check(CLI::Range(1, 1000));
  command->add_flag("--tensorboard", options->tensorboard,
                    "Also shows pictures of each checkpoint's first episode in TensorBoard");
  command
      ->add_option("--seed", options->seed, "Seed of the episodes: equal seeds give equal episodes")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--quality", options->quality,
                   "Quality of the larger view: fast | native | reference; default: native for "
                   "runs in quality native, else reference")
      ->check(CLI::IsMember({"fast", "native", "reference"}));
  command->add_option(
      "--output", options->output,
      "File to write, .mp4; default: RUN/videos/CHECKPOINT.mp4, across checkpoints across.mp4");
  command->callback([=] { *chosen = [=] { return Film(*options); }; });
}

}  // namespace shoal::launch
