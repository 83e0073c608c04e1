// SPDX-License-Identifier: Apache-2.0
#include "actor/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/dds/endpoint_options.h"

namespace shoal::actor {
namespace {

void AddOptions(CLI::App& app, Options* options) {
  app.add_option("--run", options->run, "run folder (config.json, cluster.json)");
  app.add_option("--id", options->id, "number of this actor within the run");
  app.add_option("--role", options->role, "train or eval")->check(CLI::IsMember({"train", "eval"}));
  dds::AddEndpointOptions(&app, &options->endpoint);
  app.add_flag(
      "--stop-with-input", options->stop_with_input,
      "stop when standard input ends: a remote shell's way to say that its caller is gone");
  auto* describe = app.add_flag("--describe", options->describe, "print the observation spec");
  app.add_option("--config-json", options->config_json, "configuration for --describe")
      ->needs(describe);
  auto* evaluate =
      app.add_option("--evaluate", options->checkpoint, "checkpoint folder to evaluate");
  app.add_option("--task", options->evaluation.task, "task of --evaluate instead of the run's")
      ->needs(evaluate);
  app.add_option("--episodes", options->evaluation.episodes, "episodes of --evaluate")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options->evaluation.seed, "seed of --evaluate");
  app.add_flag("--partial", options->evaluation.partial,
               "asked to stop, write the result of the episodes that were played by then")
      ->needs(evaluate);
  auto* frames = app.add_option("--frames", options->frames.file,
                                "file or pipe for what --evaluate shows, step by step")
                     ->needs(evaluate);
  app.add_option("--view", options->frames.camera,
                 "camera of the larger view among --frames; default: the run's first")
      ->needs(frames);
  app.add_option("--view-height", options->frames.height, "its height in pixels")
      ->needs(frames)
      ->check(CLI::Range(16, 2160));
  app.add_option("--view-width", options->frames.width, "its width in pixels")
      ->needs(frames)
      ->check(CLI::Range(16, 3840));
  app.add_option("--view-quality", options->frames.quality,
                 "fast | native | reference; default: native for runs in quality native, else "
                 "reference")
      ->needs(frames)
      ->check(CLI::IsMember({"fast", "native", "reference"}));
  app.add_option("--json", options->json,
                 "file for the result of --evaluate or --describe, in place of standard output");
  app.add_option("--progress", options->progress,
                 "file that says after each episode of --evaluate how many have been played")
      ->needs(evaluate);
}

}  // namespace

std::unique_ptr<CLI::App> MakeCommandLine(Options* options) {
  auto app = std::make_unique<CLI::App>(
      "Steps and renders environments for a run, or evaluates a checkpoint.", "shoal-actor");
  AddVersion(app.get());
  AddOptions(*app, options);
  return app;
}

}  // namespace shoal::actor
