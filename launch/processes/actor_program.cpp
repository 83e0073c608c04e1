// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/actor_program.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "actor/hosted/hosted_spec.h"
#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/scratch_folder.h"
#include "launch/record/evaluations.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kProgram[] = "shoal-actor";
constexpr std::chrono::seconds kProgressInterval{2};
constexpr std::chrono::seconds kDescribeDeadline{60};
constexpr std::chrono::seconds kImportDeadline{300};  // importing and testing a Python environment
constexpr std::chrono::seconds kStartDeadline{60}, kEpisodeDeadline{60};
// Time to draw and encode a thousand large pictures of quality `reference` without a GPU.
constexpr std::chrono::seconds kShownEpisodeDeadline{600};

// Like ProgramError, but names the package shoal_rl if the interpreter cannot import it.
Error ActorError(const ExitStatus& status, const fs::path& errors, const Config& config) {
  const bool no_package = !config.env.id.empty() &&
                          LastLine(errors).find("No module named 'shoal_rl") != std::string::npos;
  if (!no_package) return ProgramError(kProgram, status, errors);
  return UsageError(
      "env.python '{}' has no package shoal_rl: install its wheel there (docs/python.md)",
      config.env.python);
}

// Reports the progress lines that a program writes to its own file. Its standard output cannot be
// used for them, because a user's task may print there.
class ProgressWatch {
 public:
  // `tell` may be empty.
  ProgressWatch(fs::path file, const std::function<void(const std::string&)>& tell)
      : file_(std::move(file)), tell_(tell), due_(Now() + kProgressInterval) {}

  void Look() {
    if (!tell_ || Now() < due_) return;
    due_ = Now() + kProgressInterval;
    std::string line = LastLine(file_);
    if (line.empty() || line == told_) return;
    told_ = std::move(line);
    tell_(told_);
  }

 private:
  const fs::path file_;
  const std::function<void(const std::string&)>& tell_;
  SteadyTime due_;
  std::string told_;
};

// Runs `shoal-actor --describe` and returns its JSON.
nlohmann::json AskActor(const Config& config, std::chrono::seconds deadline) {
  const ScratchFolder scratch;
  const fs::path input = scratch.path() / kConfigFile;
  WriteFileAtomically(input, ToJson(config).dump(2));
  const fs::path answer = scratch.path() / "spec.json";
  ProcessSpec spec =
      ActorSpec(config, {"--describe", "--config-json", input.string(), "--json", answer.string()});
  spec.output = scratch.path() / "output";
  spec.errors = scratch.path() / "errors";
  const auto status = RunToEnd(spec, deadline, StopRequested);
  if (!status && StopRequested()) throw Interrupted("before anything was started");
  if (!status) throw RuntimeError("{} --describe took more than {} s", kProgram, deadline.count());
  if (!status->Clean()) throw ActorError(*status, spec.errors, config);
  return ParseStrictJson(ReadFile(answer), std::string(kProgram) + " --describe");
}

}  // namespace

DescribedEnvironment DescribeEnvironment(const Config& config) {
  const nlohmann::json answer = AskActor(config, kImportDeadline);
  const std::string version = answer.value("version", "");
  if (version != BuildVersion()) {
    throw UsageError(
        "env.python '{}' has the package shoal_rl {}, this program is {}: install the wheel of the "
        "same build there",
        config.env.python, version, BuildVersion());
  }
  const nlohmann::json& trial = answer.at("trial");
  DescribedEnvironment described{
      .description = tasks::EnvironmentFromJson(answer.at("environment")),
      .steps = trial.at("steps").get<int>(),
      .step_microseconds = trial.at("step_microseconds").get<double>(),
      .repeated_steps = trial.at("repeated_steps").get<int>()};
  if (trial.contains("differs_at")) described.differs_at = trial.at("differs_at").get<int>();
  return described;
}

ObservedWorld DescribeObservations(const Config& config) {
  if (!config.env.id.empty()) {
    return {.spec = hosted::SpecOf(DescribeEnvironment(config).description, config)};
  }
  const nlohmann::json described = AskActor(config, kDescribeDeadline);
  return {.spec = ObservationSpecFromJson(described),
          .frame_microseconds = described.value("frame_microseconds", 0.0),
          .step_microseconds = described.value("step_microseconds", 0.0)};
}

std::optional<EvaluationPoint> EvaluateByActor(const EvaluationOrder& order,
                                               const std::function<bool()>& stop) {
  const ScratchFolder scratch =
      order.own_run ? ScratchFolder::WithinRun(order.run) : ScratchFolder();
  const fs::path json = order.json.empty() ? scratch.path() / "result.json" : order.json;
  const Config config = ReadRunConfig(order.run).config;
  ProcessSpec spec =
      ActorSpec(config, {"--evaluate", order.checkpoint.string(), "--run", order.run.string(),
                         "--episodes", std::to_string(order.episodes), "--seed",
                         std::to_string(order.seed), "--json", json.string()});
  if (!order.task.empty()) spec.command.insert(spec.command.end(), {"--task", order.task});
  if (order.partial) spec.command.emplace_back("--partial");
  const bool shown = !order.frames.stream.empty();
  if (shown) {
    const std::string side = std::to_string(order.frames.side);
    spec.command.insert(spec.command.end(), {"--frames", order.frames.stream.string(),
                                             "--view-height", side, "--view-width", side});
    if (!order.frames.quality.empty()) {
      spec.command.insert(spec.command.end(), {"--view-quality", order.frames.quality});
    }
  }
  const fs::path played = scratch.path() / "progress";
  if (order.progress) spec.command.insert(spec.command.end(), {"--progress", played.string()});
  spec.output = scratch.path() / "output";
  spec.errors = scratch.path() / "errors";
  ProgressWatch progress(played, order.progress);
  const std::chrono::seconds deadline =
      kStartDeadline + order.episodes * (shown ? kShownEpisodeDeadline : kEpisodeDeadline);
  const auto status = RunToEnd(spec, deadline, [&] {
    progress.Look();
    return stop();
  });
  if (!status && stop()) {
    if (!order.partial || !fs::exists(json)) return std::nullopt;
    return ParseEvaluation(ReadFile(json), json);
  }
  if (!status) {
    throw RuntimeError("evaluation of '{}' took more than {} s", order.checkpoint.string(),
                       deadline.count());
  }
  if (!status->Clean()) throw ActorError(*status, spec.errors, config);
  return ParseEvaluation(ReadFile(json), json);
}

}  // namespace shoal::launch
