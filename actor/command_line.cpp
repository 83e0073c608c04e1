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
  app.add_flag("--stop-with-input", options->stop_with_input,
               "stop when standard input ends, which a remote shell closes when its caller ends");
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
               "on a stop signal, write the result of the episodes played so far")
      ->needs(evaluate);
  auto* frames = app.add_option("--frames", options->frames.file,
                                "file or pipe for the frames of --evaluate, step by step")
                     ->needs(evaluate);
  app.add_option("--view", options->frames.camera,
                 "camera of the larger view among --frames; default: the run's first")
      ->needs(frames);
  app.add_option("--view-height", options->frames.height, "height of the larger view in pixels")
      ->needs(frames)
      ->check(CLI::Range(16, 2160));
  app.add_option("--view-width", options->frames.width, "width of the larger view in pixels")
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
                 "file for the number of episodes played, written after each episode of --evaluate")
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
