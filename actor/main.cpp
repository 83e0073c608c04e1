// shoal-actor: one program, four uses: training actor, evaluation actor, evaluation of a
// checkpoint, description of what the actors of a configuration observe.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "actor/eval_actor.h"
#include "actor/evaluation.h"
#include "actor/training_actor.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/own_tasks.h"
#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/base/stop_with_input.h"
#include "common/config/config_io.h"
#include "common/dds/bus.h"
#include "common/nn/precision.h"

namespace {

struct Options {
  std::string run, role = "train", config_json, checkpoint, task, json;
  uint32_t id = 0;
  int episodes = 100;
  int64_t seed = 1;
  bool describe = false, stop_with_input = false;
  shoal::dds::Reach reach;
};

int Describe(const Options& options) {
  shoal::Config config;
  shoal::ApplyJson(
      shoal::ParseStrictJson(shoal::ReadFile(options.config_json), options.config_json),
      options.config_json, &config);
  std::shared_ptr<shoal::worlds::RenderContext> render;
  if (config.observation.pixels) render = shoal::worlds::MakeRenderContext(config.observation);
  const auto environment = shoal::worlds::MakeEnvironment(config, render);
  std::cout << shoal::ToJson(environment->spec()).dump(2) << std::endl;
  return 0;
}

int Evaluate(const Options& options) {
  const std::string result =
      shoal::actor::EvaluateCheckpoint(options.run, options.checkpoint, options.episodes,
                                       options.seed, options.task)
          .dump(2);
  if (options.json.empty()) {
    std::cout << result << std::endl;
  } else {
    shoal::WriteFileAtomically(options.json, result + "\n");
  }
  return 0;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("Steps and renders environments for a run, or evaluates a checkpoint.");
  app.set_version_flag("--version", shoal::BuildVersion());
  app.add_option("--run", options.run, "run folder (config.json, cluster.json)");
  app.add_option("--id", options.id, "number of this actor within the run");
  app.add_option("--role", options.role, "train or eval")->check(CLI::IsMember({"train", "eval"}));
  app.add_option("--peer", options.reach.peer,
                 "HOST[:PORT] of the servers instead of cluster.json's");
  app.add_option("--interface", options.reach.interface,
                 "network interface of this host instead of transport.interface");
  app.add_option("--secure", options.reach.secure,
                 "folder of credentials instead of cluster.json's (shoal secure init)");
  app.add_flag(
      "--stop-with-input", options.stop_with_input,
      "stop when standard input ends: a remote shell's way to say that its caller is gone");
  auto* describe = app.add_flag("--describe", options.describe, "print the observation spec");
  app.add_option("--config-json", options.config_json, "configuration for --describe")
      ->needs(describe);
  auto* evaluate =
      app.add_option("--evaluate", options.checkpoint, "checkpoint folder to evaluate");
  app.add_option("--task", options.task, "task of --evaluate instead of the run's")
      ->needs(evaluate);
  app.add_option("--episodes", options.episodes, "episodes of --evaluate")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "seed of --evaluate");
  app.add_option("--json", options.json, "file for the result of --evaluate");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    throw shoal::UsageError("{}", e.what());
  }

  shoal::worlds::RegisterOwnTasks();
  shoal::nn::SetThreads(1);  // one thread per actor: cores are filled with actors
  if (options.describe) {
    if (options.config_json.empty()) throw shoal::UsageError("--describe needs --config-json FILE");
    return Describe(options);
  }
  if (options.run.empty()) throw shoal::UsageError("--run DIR is required");
  shoal::InstallStopSignals();
  if (!options.checkpoint.empty()) return Evaluate(options);
  std::optional<shoal::StopWithInput> stop_with_input;
  if (options.stop_with_input) stop_with_input.emplace();
  if (options.role == "eval") {
    shoal::log::Start("eval-0", "");
    return shoal::actor::RunEvalActor(options.run, options.reach);
  }
  shoal::log::Start(fmt::format("actor-{}", options.id), "");
  return shoal::actor::RunTrainingActor(options.run, options.id, options.reach);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-actor", [&] { return Run(argc, argv); });
}
