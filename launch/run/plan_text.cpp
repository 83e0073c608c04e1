// SPDX-License-Identifier: Apache-2.0
#include "launch/run/plan_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/on_policy.h"
#include "common/nn/precision.h"
#include "common/tasks/task_registry.h"
#include "launch/record/run_inputs.h"
#include "learner/agent/update_cost.h"
#include "replay_server/core/storage_needs.h"

namespace shoal::launch {
namespace {

constexpr double kMega = 1e6, kGiga = 1e9;

std::string PicturesText(const RunConfig& run, double frame_microseconds) {
  if (!run.config.observation.pixels) return "no pictures";
  if (!run.config.env.id.empty()) {
    return fmt::format("the environment draws, {} camera(s)", run.spec.cameras.size());
  }
  const std::string& quality = run.config.observation.quality;
  return fmt::format("{} ({}) draws a frame, {} camera(s), in {:.0f} us{}",
                     quality == "native" ? "Shoal's renderer" : "OSMesa", quality,
                     run.spec.cameras.size(), frame_microseconds,
                     run.spec.goal_picture ? ", and a goal picture for each episode" : "");
}

std::string ReplayText(const RunConfig& run) {
  if (LearnsOnPolicy(run.config)) {
    return fmt::format("no replay, rollouts of {} steps of {} environments",
                       run.config.ppo.rollout_steps, run.config.actors * run.config.envs_per_actor);
  }
  const replay::StorageNeeds needs = replay::StorageNeedsOf(run);
  return fmt::format("replay of {} records: {:.0f} MB in {}, {:.0f} MB of memory beside it",
                     run.config.replay.capacity, static_cast<double>(needs.ring_bytes) / kMega,
                     run.config.replay.storage == "memory" ? "memory" : "a file",
                     static_cast<double>(needs.memory_bytes) / kMega);
}

std::string PaceText(const Config& config) {
  if (LearnsOnPolicy(config)) {
    return fmt::format("an update per {} env steps",
                       int64_t{config.ppo.rollout_steps} * config.actors * config.envs_per_actor);
  }
  const Schedule& samples = config.replay.samples_per_insert;
  const double first = samples.start / config.learner.batch;
  const double last = samples.end / config.learner.batch;
  if (samples.Most() <= 0) return "updates as fast as the learner can";
  if (samples.constant()) return fmt::format("{:.3g} updates per env step", first);
  return fmt::format("{:.3g} updates per env step at the start, {:.3g} from {} env steps on", first,
                     last, samples.env_steps);
}

nn::Precision PrecisionOf(const Config& config) {
  const auto choose =
      config.learner.device == "cuda" ? nn::ChooseGpuPrecision : nn::ChoosePrecision;
  return choose(config.learner.precision, config.observation.pixels);
}

std::string UpdateText(const RunConfig& run) {
  const Config& config = run.config;
  const learner::UpdateCost cost = learner::CostOfUpdate(config, run.spec);
  const std::string encoder = config.observation.pixels
                                  ? fmt::format("encoder {} of {} parameters, ",
                                                config.network.encoder, cost.encoder_parameters)
                                  : "";
  return fmt::format("{} in {}: {}batch {}, {:.3g} GFLOP an update", config.learner.algorithm,
                     nn::ToString(PrecisionOf(config)), encoder, config.learner.batch,
                     cost.flop / kGiga);
}

// Privileged inputs of the training. Results of the run must name them.
std::string PrivilegedText(const RunConfig& run) {
  const PrivilegedInputs inputs = PrivilegedInputsOf(run.config, run.spec);
  std::vector<std::string> lines;
  if (!inputs.critic_blocks.empty()) {
    lines.push_back(fmt::format("the critic sees {}{}", fmt::join(inputs.critic_blocks, ", "),
                                run.spec.HasPixels() ? " in place of pixels" : ""));
  }
  if (!inputs.labels.empty()) {
    lines.push_back(fmt::format("the encoder predicts {}", fmt::join(inputs.labels, ", ")));
  }
  if (!inputs.replay_blocks.empty()) lines.push_back("the replay " + HindsightText(run));
  if (lines.empty()) return "";
  return fmt::format("  privileged, in training alone: {}\n", fmt::join(lines, ", "));
}

// "From pixels" suggests that the policy finds the object in its pictures. If its inputs contain
// the object's position, results must say so.
std::string ObjectText(const ObservationSpec& spec) {
  const std::vector<std::string> blocks = PolicyInputsOf(spec).object_blocks;
  if (!spec.HasPixels() || blocks.empty()) return "";
  return fmt::format(
      "  besides its pictures the policy gets the object's position, also at test time: {}\n",
      fmt::join(blocks, ", "));
}

// A single frame shows no velocity. Tasks with a success can be solved without velocities.
std::string StackText(const RunConfig& run) {
  const auto tells_velocity = [](const BlockSpec& block) {
    return block.observed && block.name.find("velocit") != std::string::npos;
  };
  if (!run.spec.HasPixels() || run.config.observation.stack > 1 ||
      tasks::FindTask(run.config.task).has_success() ||
      std::ranges::any_of(run.spec.blocks, tells_velocity)) {
    return "";
  }
  return "  observation.stack = 1: the policy sees no velocity; 3 is usual for this task\n";
}

// The preset's configuration, or the defaults if there is no preset. Empty if the preset names no
// task or cannot be read: the run does not need it.
std::optional<Config> StartOf(const Config& config) {
  if (config.preset.empty()) return Config();
  try {
    const std::string file = FindPreset(config.preset);
    if (!ParseStrictJson(ReadFile(file), file).contains("task")) return std::nullopt;
    return LoadPreset(config.preset);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// Names keys whose values were chosen for another task: those unchanged from the preset or the
// defaults.
std::string DefaultsText(const Config& config) {
  const std::optional<Config> start = StartOf(config);
  if (!start || config.task == start->task) return "";
  std::string kept;
  const auto keep = [&](const char* key, double value, double at_start) {
    if (value == at_start) kept += fmt::format("{}{} = {}", kept.empty() ? "" : ", ", key, value);
  };
  keep("learner.discount", config.learner.discount, start->learner.discount);
  keep("learner.reward_scale", config.learner.reward_scale, start->learner.reward_scale);
  if (kept.empty()) return "";
  return fmt::format("  {}: {} as {} needs it\n",
                     config.preset.empty() ? "no preset" : "preset " + config.preset, kept,
                     start->task);
}

}  // namespace

std::string PlanText(const RunConfig& run, double frame_microseconds) {
  return fmt::format("  {}; {}\n  {}; {}\n{}{}{}{}", PicturesText(run, frame_microseconds),
                     ReplayText(run), PaceText(run.config), UpdateText(run), PrivilegedText(run),
                     ObjectText(run.spec), StackText(run), DefaultsText(run.config));
}

std::string SharedCoresText(int actors, int cores) {
  if (actors <= cores) return "";
  return fmt::format("{} actors share {} core(s): actors and learner get less time each", actors,
                     cores);
}

}  // namespace shoal::launch
