// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/config/privileged_blocks.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

bool NamesAnObject(const BlockSpec& block) { return block.name.starts_with("object"); }

// "grip (3), fingers (2)", or "nothing".
std::string Listed(const ObservationSpec& spec, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", name, spec.Recorded(name)->size);
  }
  return text.empty() ? "nothing" : text;
}

// Empty if no goal is drawn.
std::string MarkerText(const RunConfig& run) {
  if (!run.spec.Recorded("desired_goal")) return "";
  const bool hidden = run.config.replay.hindsight != "none" || run.spec.goal_picture;
  return hidden ? ", the goal's marker hidden" : ", with the goal's marker";
}

std::string PicturesText(const RunConfig& run) {
  const ObservationSpec& spec = run.spec;
  if (!spec.HasPixels()) return "none";
  return fmt::format("{} at {}x{}{}, {} frame(s){}{}", fmt::join(spec.cameras, ", "), spec.height,
                     spec.width, run.config.observation.grey ? " grey" : "", spec.stack,
                     spec.goal_picture ? " and a picture of the goal reached" : "",
                     MarkerText(run));
}

// Recorded blocks that are inputs of neither the policy nor the training.
std::vector<std::string> Unused(const RunConfig& run) {
  std::vector<std::string> told = PrivilegedBlocksOf(run.config, run.spec).all;
  for (std::string& name : PrivilegedInputsOf(run.config, run.spec).replay_blocks) {
    told.push_back(std::move(name));
  }
  std::vector<std::string> unused;
  for (const BlockSpec& block : run.spec.blocks) {
    if (!block.observed && std::ranges::count(told, block.name) == 0) unused.push_back(block.name);
  }
  return unused;
}

std::string PrivilegedLines(const RunConfig& run) {
  const ObservationSpec& spec = run.spec;
  const PrivilegedInputs inputs = PrivilegedInputsOf(run.config, spec);
  if (inputs.critic_blocks.empty() && inputs.labels.empty() && inputs.replay_blocks.empty()) {
    return "privileged, in training alone: nothing\n";
  }
  std::string text = "privileged, in training alone:\n";
  if (!inputs.critic_blocks.empty()) {
    text += fmt::format("  the critic sees        {}{}\n", Listed(spec, inputs.critic_blocks),
                        spec.HasPixels() ? ", in place of pixels" : "");
  }
  if (!inputs.labels.empty()) {
    text += fmt::format("  the encoder predicts   {}\n", fmt::join(inputs.labels, ", "));
  }
  if (!inputs.replay_blocks.empty()) {
    text += fmt::format("  the replay             {}\n", HindsightText(run));
  }
  return text;
}

}  // namespace

PolicyInputs PolicyInputsOf(const ObservationSpec& spec) {
  PolicyInputs inputs{.cameras = spec.cameras, .goal_picture = spec.goal_picture};
  const bool has_object = std::ranges::any_of(spec.blocks, NamesAnObject);
  for (const BlockSpec& block : spec.blocks) {
    if (!block.observed) continue;
    inputs.blocks.push_back(block.name);
    if (NamesAnObject(block) || (has_object && block.name == "achieved_goal")) {
      inputs.object_blocks.push_back(block.name);
    }
  }
  return inputs;
}

PrivilegedInputs PrivilegedInputsOf(const Config& config, const ObservationSpec& spec) {
  PrivilegedInputs inputs{.critic_blocks = PrivilegedBlocksOf(config, spec).critic,
                          .labels = config.sac.aux};
  const auto achieved = std::ranges::find(spec.blocks, "achieved_goal", &BlockSpec::name);
  const bool to_be_seen = spec.HasPixels() && achieved != spec.blocks.end() && !achieved->observed;
  if (to_be_seen && config.replay.hindsight != "none") inputs.replay_blocks = {achieved->name};
  return inputs;
}

std::string HindsightText(const RunConfig& run) {
  const std::vector<std::string> blocks = PrivilegedInputsOf(run.config, run.spec).replay_blocks;
  if (blocks.empty()) return "";
  const ReplayConfig& replay = run.config.replay;
  const char* distance = replay.movement == "displacement" ? "its remaining displacement"
                                                           : "its remaining path length";
  return fmt::format("relabels goals with {}{}", fmt::join(blocks, ", "),
                     replay.movement_share > 0
                         ? fmt::format(" and draws {:.3g} % of the samples by {}",
                                       100 * replay.movement_share, distance)
                         : "");
}

ordered_json ToJson(const PolicyInputs& inputs) {
  return {{"blocks", inputs.blocks},
          {"object_blocks", inputs.object_blocks},
          {"cameras", inputs.cameras},
          {"goal_picture", inputs.goal_picture}};
}

ordered_json ToJson(const PrivilegedInputs& inputs) {
  return {{"critic_blocks", inputs.critic_blocks},
          {"labels", inputs.labels},
          {"replay_blocks", inputs.replay_blocks}};
}

std::string DescribeInputs(const RunConfig& run) {
  const PolicyInputs policy = PolicyInputsOf(run.spec);
  std::string text = fmt::format(
      "{}: what the policy gets, in training and at test time:\n"
      "  pictures  {}\n"
      "  numbers   {}\n",
      run.spec.task, PicturesText(run), Listed(run.spec, policy.blocks));
  if (!policy.object_blocks.empty()) {
    text +=
        fmt::format("  of these describe the object: {}\n", fmt::join(policy.object_blocks, ", "));
  }
  text += PrivilegedLines(run);
  return text + fmt::format("also recorded: {}\n", Listed(run.spec, Unused(run)));
}

ordered_json InputsJson(const RunConfig& run) {
  const ObservationSpec& spec = run.spec;
  ordered_json recorded = ordered_json::array();
  for (const BlockSpec& block : spec.blocks) {
    recorded.push_back({{"name", block.name}, {"size", block.size}});
  }
  return {{"schema", "shoal-inputs-1"},
          {"task", spec.task},
          {"height", spec.height},
          {"width", spec.width},
          {"stack", spec.stack},
          {"policy_inputs", ToJson(PolicyInputsOf(spec))},
          {"privileged_inputs", ToJson(PrivilegedInputsOf(run.config, spec))},
          {"recorded_blocks", recorded}};
}

}  // namespace shoal::launch
