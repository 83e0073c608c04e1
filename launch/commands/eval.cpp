// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/commands/commands.h"
#include "launch/commands/json_output.h"
#include "launch/commands/target_options.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/scratch_folder.h"
#include "launch/record/evaluation_seed.h"
#include "launch/record/run_folder.h"
#include "launch/run/baselines.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

struct EvalOptions {
  CheckpointWords checkpoint;
  std::string task, json;
  int episodes = 100;
  std::optional<int64_t> seed{};  // empty: the run's own (evaluation_seed.h)
};

std::string WithBaselines(const std::string& result, const Baselines& baselines) {
  auto object = ParseBoundedJson<nlohmann::ordered_json>(result);
  object["baselines"] = ToJson(std::optional(baselines));
  return object.dump(2) + "\n";
}

// "failed 3: 2 stopped_short, 1 never_touched", most frequent first; empty if no episode failed or
// the task has no failure causes (actor/evaluation/failure_cause.h).
std::string FailuresText(const fs::path& file) {
  const auto object = ParseBoundedJson<nlohmann::ordered_json>(ReadFile(file));
  const auto counts = object.find("failures");
  if (counts == object.end()) return "";
  std::vector<std::pair<uint64_t, std::string>> failures;
  for (const auto& [cause, count] : counts->items()) {
    if (count > 0) failures.emplace_back(count.get<uint64_t>(), cause);
  }
  std::ranges::stable_sort(failures, std::greater<>(), &std::pair<uint64_t, std::string>::first);
  uint64_t all = 0;
  std::string text;
  for (const auto& [count, cause] : failures) {
    all += count;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, cause);
  }
  return text.empty() ? "" : fmt::format("failed {}: {}", all, text);
}

// Finds a checkpoint that belongs to a run, because the run's configuration is needed to play it.
NamedCheckpoint FindRunCheckpoint(const CheckpointWords& words) {
  NamedCheckpoint named = FindCheckpoint(words);
  if (!named.run.empty()) return named;
  throw UsageError("'{}' is neither a run nor RUN/checkpoints/NAME: there is no '{}'",
                   named.checkpoint.string(),
                   (named.checkpoint.parent_path().parent_path() / kConfigFile).string());
}

int WasInterrupted(const std::string& what) {
  fmt::print(stderr, "shoal: interrupted: {}\n", what);
  return kInterruptedExit;
}

int Evaluate(const EvalOptions& options) {
  const auto [run, folder] = FindRunCheckpoint(options.checkpoint);
  const JsonOutput output(options.json);
  InstallStopSignals();
  const int64_t seed = options.seed ? *options.seed : OwnEvaluationSeed(run);
  if (seed == kReservedEvaluationSeed) {
    fmt::print(
        stderr,
        "seed {} is reserved for final figures: do not select recipes or checkpoints with it\n",
        seed);
  }
  const ScratchFolder scratch;
  const fs::path json = scratch.path() / "eval.json";
  const auto point = EvaluateByActor(
      {.run = run,
       .checkpoint = folder,
       .episodes = options.episodes,
       .seed = seed,
       .task = options.task,
       .json = json,
       .partial = true,
       .progress = [](const std::string& line) { fmt::print(stderr, "played {}\n", line); }},
      StopRequested);
  if (!point) return WasInterrupted("nothing was evaluated");
  fmt::print(output.text(), "{} episodes (seed {}) of {}: {} ({} env steps, {} updates)\n",
             point->episodes, seed, folder.string(), FormatWholeScore(*point), point->env_steps,
             point->updates);
  if (const std::string failures = FailuresText(json); !failures.empty()) {
    fmt::print(output.text(), "{}\n", failures);
  }
  const std::string result = ReadFile(json);
  output.WriteEarly(result);
  if (std::cmp_less(point->episodes, options.episodes)) {
    output.Write(result);
    return WasInterrupted(
        fmt::format("partial: the first {} of {} episodes, equal to a run with --episodes {}",
                    point->episodes, options.episodes, point->episodes));
  }
  Config played = ReadRunConfig(run).config;
  if (!HasBaselines(played)) {
    output.Write(result);
    return 0;
  }
  if (!options.task.empty()) {  // evaluated without the run's model file
    played.task = options.task;
    played.model.clear();
  }
  const auto baselines = BaselineCache().Measure(
      played, StopRequested, [](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  if (!baselines) {
    output.Write(result);
    return WasInterrupted("the baselines were skipped");
  }
  fmt::print(output.text(), "{} {}\n", played.task, FormatBaselines(*baselines));
  output.Write(WithBaselines(result, *baselines));
  return 0;
}

}  // namespace

void AddEvalCommand(CLI::App& app, Action* chosen) {
  CLI::App* command =
      app.add_subcommand("eval",
                         "Evaluate a checkpoint on fresh episodes, with the policy's mean actions. "
                         "Ctrl-C ends it with the result of the episodes played so far.");
  const auto options = std::make_shared<EvalOptions>();
  AddCheckpointOptions(*command, &options->checkpoint);
  command->add_option("--episodes", options->episodes, "Episodes to play")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--seed", options->seed,
                   "Seed of the episodes: equal seeds give equal episodes. Default: derived from "
                   "the run's config.json, so that each run and recipe has its own episodes")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--task", options->task,
                      "Another task, whose observations and actions have the same sizes as the "
                      "run's; played without the run's randomization and model file");
  command->add_option("--json", options->json,
                      "File for every episode; - for standard output (schema shoal-eval-1)");
  command->callback([=] { *chosen = [=] { return Evaluate(*options); }; });
}

}  // namespace shoal::launch
