// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/actor_program.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"
#include "common/config/config_io.h"
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
constexpr std::chrono::seconds kStartDeadline{60}, kEpisodeDeadline{60};
// A thousand larger pictures of the reference quality, drawn without a GPU and encoded.
constexpr std::chrono::seconds kShownEpisodeDeadline{600};

// Follows the progress that a program writes into a file of its own: a user's task may print to the
// program's standard output.
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

}  // namespace

ObservedWorld DescribeObservations(const Config& config) {
  const ScratchFolder scratch;
  const fs::path input = scratch.path() / kConfigFile;
  WriteFileAtomically(input, ToJson(config).dump(2));
  const fs::path answer = scratch.path() / "spec.json";
  ProcessSpec spec = ProgramSpec(
      kProgram, {"--describe", "--config-json", input.string(), "--json", answer.string()}, 1);
  spec.output = scratch.path() / "output";
  spec.errors = scratch.path() / "errors";
  const auto status = RunToEnd(spec, kDescribeDeadline, StopRequested);
  if (!status && StopRequested()) throw Interrupted("before anything was started");
  if (!status) {
    throw RuntimeError("{} --describe took more than {} s", kProgram, kDescribeDeadline.count());
  }
  if (!status->Clean()) throw ProgramError(kProgram, *status, spec.errors);
  const nlohmann::json described =
      ParseStrictJson(ReadFile(answer), std::string(kProgram) + " --describe");
  return {.spec = ObservationSpecFromJson(described),
          .frame_microseconds = described.value("frame_microseconds", 0.0),
          .step_microseconds = described.value("step_microseconds", 0.0)};
}

std::optional<EvaluationPoint> EvaluateByActor(const EvaluationOrder& order,
                                               const std::function<bool()>& stop) {
  const ScratchFolder scratch =
      order.own_run ? ScratchFolder::WithinRun(order.run) : ScratchFolder();
  const fs::path json = order.json.empty() ? scratch.path() / "result.json" : order.json;
  ProcessSpec spec = ProgramSpec(kProgram,
                                 {"--evaluate", order.checkpoint.string(), "--run",
                                  order.run.string(), "--episodes", std::to_string(order.episodes),
                                  "--seed", std::to_string(order.seed), "--json", json.string()},
                                 1);
  if (!order.task.empty()) spec.command.insert(spec.command.end(), {"--task", order.task});
  if (order.partial) spec.command.emplace_back("--partial");
  const bool shown = !order.frames.stream.empty();
  if (shown) {
    const std::string side = std::to_string(order.frames.side);
    spec.command.insert(spec.command.end(), {"--frames", order.frames.stream.string(),
                                             "--view-height", side, "--view-width", side});
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
  if (!status->Clean()) throw ProgramError(kProgram, *status, spec.errors);
  return ParseEvaluation(ReadFile(json), json);
}

}  // namespace shoal::launch
