// SPDX-License-Identifier: Apache-2.0
#include "actor/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "actor/command_line.h"
#include "actor/evaluation/eval_actor.h"
#include "actor/loop/training_actor.h"
#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/base/stop.h"
#include "common/base/stop_with_input.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/dds/bus.h"
#include "common/nn/precision.h"
#include "common/wire/process_name.h"

namespace shoal::actor {
namespace {

// Returns an exit code if the command line only asked for help or the version.
std::optional<int> Parse(int argc, char** argv, Options* options) {
  const auto app = MakeCommandLine(options);
  if (const auto exit_code = ParseCommandLine(app.get(), argc, argv)) return exit_code;
  if (options->describe && options->config_json.empty()) {
    throw UsageError("--describe needs --config-json FILE");
  }
  if (!options->describe && options->run.empty()) throw UsageError("--run DIR is required");
  return std::nullopt;
}

// Writes the answer to a file for the calling program: a user's task may print to standard output.
void Answer(const Options& options, const std::string& json) {
  if (options.json.empty()) {
    std::cout << json << std::endl;
  } else {
    WriteFileAtomically(options.json, json + "\n");
  }
}

int Describe(const Options& options, const ActorParts& parts) {
  Config config;
  ApplyJson(ParseStrictJson(ReadFile(options.config_json), options.config_json),
            options.config_json, &config);
  Answer(options, parts.describe(config).dump(2));
  return 0;
}

int Evaluate(const Options& options, const EvaluationEnvironments& environments) {
  CheckpointEvaluation evaluation = options.evaluation;
  if (!options.frames.file.empty()) evaluation.frames = options.frames;
  std::ofstream progress;
  if (!options.progress.empty()) {
    progress.open(options.progress, std::ios::app);
    if (!progress) throw RuntimeError("cannot write '{}'", options.progress);
    evaluation.on_ended = [&progress, asked = evaluation.episodes](int ended) {
      progress << ended << " of " << asked << " episodes" << std::endl;
    };
  }
  Answer(options,
         EvaluateCheckpoint(options.run, options.checkpoint, evaluation, environments).dump(2));
  return 0;
}

int RunActor(const Options& options, const EnvironmentFactory& make) {
  const bool evaluates = options.role == "eval";
  log::Start((evaluates ? ProcessName::Evaluation() : ProcessName::Actor(options.id)).Text(), "");
  KeepSecuredRunPrivate(options.run);
  std::optional<StopWithInput> stop_with_input;
  if (options.stop_with_input) stop_with_input.emplace();
  const RunMembership member(options.run);
  const Config config = ReadRunConfig(options.run).config;
  dds::Bus bus(dds::FindEndpoint(options.run, config.transport, options.endpoint),
               evaluates ? dds::Role::kEval : dds::Role::kActor);
  if (evaluates) return EvalActor(options.run, bus, make).Run();
  return TrainingActor(options.run, options.id, bus, make).Run();
}

}  // namespace

int RunActorProgram(int argc, char** argv, const ActorParts& parts) {
  Options options;
  if (const auto exit_code = Parse(argc, argv, &options)) return *exit_code;
  nn::SetThreads(1);  // one thread per actor, because actors fill the cores
  if (options.describe) return Describe(options, parts);
  parts.add_tasks(ReadRunConfig(options.run));
  InstallStopSignals();
  return options.checkpoint.empty() ? RunActor(options, parts.environments.make)
                                    : Evaluate(options, parts.environments);
}

}  // namespace shoal::actor
