#include "actor/program.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "actor/evaluation/eval_actor.h"
#include "actor/evaluation/evaluation.h"
#include "actor/loop/training_actor.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/physics_library.h"
#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/base/stop.h"
#include "common/base/stop_with_input.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/nn/precision.h"

namespace shoal::actor {
namespace {

struct Options {
  std::string run, role = "train", config_json, checkpoint, json;
  uint32_t id = 0;
  CheckpointEvaluation evaluation;
  FrameRecorder::Options frames;
  bool describe = false, stop_with_input = false;
  dds::Reach reach;
};

void AddOptions(CLI::App& app, Options* options) {
  app.add_option("--run", options->run, "run folder (config.json, cluster.json)");
  app.add_option("--id", options->id, "number of this actor within the run");
  app.add_option("--role", options->role, "train or eval")->check(CLI::IsMember({"train", "eval"}));
  app.add_option("--peer", options->reach.peer,
                 "HOST[:PORT] of the servers instead of cluster.json's");
  app.add_option("--interface", options->reach.interface,
                 "network interface of this host instead of transport.interface");
  app.add_option("--secure", options->reach.secure,
                 "folder of credentials instead of cluster.json's (shoal secure init)");
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
  app.add_option("--json", options->json, "file for the result of --evaluate");
}

// An exit code where the command line asked for nothing but help or the version.
std::optional<int> Parse(int argc, char** argv, Options* options) {
  CLI::App app("Steps and renders environments for a run, or evaluates a checkpoint.");
  app.set_version_flag("--version", BuildVersion());
  AddOptions(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    throw UsageError("{}", e.what());
  }
  if (options->describe && options->config_json.empty()) {
    throw UsageError("--describe needs --config-json FILE");
  }
  if (!options->describe && options->run.empty()) throw UsageError("--run DIR is required");
  return std::nullopt;
}

// Of one environment's cameras together, over some steps of an episode.
double FrameMicroseconds(worlds::Environment& environment) {
  constexpr int kSteps = 10;
  const ObservationSpec& spec = environment.spec();
  std::vector<uint8_t> frame(spec.FrameBytes());
  std::vector<float> vector(static_cast<size_t>(spec.RecordedVectorSize()));
  const std::vector<float> action(static_cast<size_t>(spec.action_size));
  const worlds::ObservationOut out{.frame = frame, .vector = vector};
  environment.Reset(StreamKey(0, StreamRole::kEvalEnvironment, 0),
                    out);  // the first frame prepares much
  const double before = environment.render_seconds();
  for (int i = 0; i < kSteps; ++i) {
    if (environment.Step(action, out).terminated) break;
  }
  return 1e6 * (environment.render_seconds() - before) / kSteps;
}

int Describe(const Options& options) {
  Config config;
  ApplyJson(ParseStrictJson(ReadFile(options.config_json), options.config_json),
            options.config_json, &config);
  worlds::LoadTasks(config.task_library);
  std::shared_ptr<worlds::RenderContext> render;
  if (config.observation.pixels) render = worlds::MakeRenderContext(config.observation);
  const auto environment = worlds::MakeEnvironment(config, render);
  nlohmann::ordered_json description = ToJson(environment->spec());
  description["frame_microseconds"] = FrameMicroseconds(*environment);
  std::cout << description.dump(2) << std::endl;
  return 0;
}

int Evaluate(const Options& options) {
  CheckpointEvaluation evaluation = options.evaluation;
  if (!options.frames.file.empty()) evaluation.frames = options.frames;
  const std::string result =
      EvaluateCheckpoint(options.run, options.checkpoint, evaluation).dump(2);
  if (options.json.empty()) {
    std::cout << result << std::endl;
  } else {
    WriteFileAtomically(options.json, result + "\n");
  }
  return 0;
}

int RunActor(const Options& options) {
  std::optional<StopWithInput> stop_with_input;
  if (options.stop_with_input) stop_with_input.emplace();
  if (options.role == "eval") {
    log::Start("eval-0", "");
    return RunEvalActor(options.run, options.reach);
  }
  log::Start(fmt::format("actor-{}", options.id), "");
  return RunTrainingActor(options.run, options.id, options.reach);
}

}  // namespace

int RunActorProgram(int argc, char** argv) {
  Options options;
  if (const auto exit_code = Parse(argc, argv, &options)) return *exit_code;
  nn::SetThreads(1);  // one thread per actor: cores are filled with actors
  if (options.describe) return Describe(options);
  worlds::LoadTasks(ReadRunConfig(options.run).config.task_library);
  InstallStopSignals();
  return options.checkpoint.empty() ? RunActor(options) : Evaluate(options);
}

}  // namespace shoal::actor
