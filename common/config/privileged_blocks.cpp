// SPDX-License-Identifier: Apache-2.0
#include "common/config/privileged_blocks.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "common/base/error.h"

namespace shoal {
namespace {

enum class Which { kRecorded, kUnobserved };

std::string BlocksOf(const ObservationSpec& spec, Which which) {
  std::string blocks;
  for (const BlockSpec& block : spec.blocks) {
    if (which == Which::kUnobserved && block.observed) continue;
    blocks += fmt::format("{}{} ({})", blocks.empty() ? "" : ", ", block.name, block.size);
  }
  return blocks.empty() ? "none" : blocks;
}

int SizeOf(const char* key, const std::string& block, const ObservationSpec& spec) {
  const auto range = spec.Recorded(block);
  if (!range) {
    throw UsageError("{}: {} records no block '{}'; expected some of: {}", key, spec.task, block,
                     BlocksOf(spec, Which::kRecorded));
  }
  return range->size;
}

std::vector<std::string> CriticBlocks(const StateBlocks& asked, const ObservationSpec& spec) {
  for (const std::string& name : asked.names) SizeOf("sac.critic_blocks", name, spec);
  std::vector<std::string> critic;
  for (const BlockSpec& block : spec.blocks) {
    const bool named = asked.all || std::ranges::count(asked.names, block.name) > 0;
    if (named && !block.observed) critic.push_back(block.name);
  }
  // Without pixels, a critic that observes no more blocks than the policy would lack what pixels
  // show.
  if (asked && critic.empty()) {
    throw UsageError(
        "sac.critic_blocks: the policy of {} observes all of {}, which leaves the critic "
        "nothing in place of the pixels; expected some of those that it does not observe: {}",
        spec.task,
        asked.all ? "the recorded blocks" : fmt::format("{}", fmt::join(asked.names, ", ")),
        BlocksOf(spec, Which::kUnobserved));
  }
  return critic;
}

// A block's name may contain a dash, so only a text that is no block is read as a difference.
AuxLabel LabelOf(const std::string& text, const ObservationSpec& spec) {
  constexpr const char* kKey = "sac.aux";
  const size_t dash = text.find('-');
  if (spec.Recorded(text) || dash == std::string::npos) {
    return {.block = text, .minus = "", .size = SizeOf(kKey, text, spec)};
  }
  AuxLabel label{.block = text.substr(0, dash), .minus = text.substr(dash + 1)};
  label.size = SizeOf(kKey, label.block, spec);
  const int taken_off = SizeOf(kKey, label.minus, spec);
  if (label.size != taken_off) {
    throw UsageError("{}: '{}' is of {} and {} numbers, expected two blocks of one size", kKey,
                     text, label.size, taken_off);
  }
  return label;
}

}  // namespace

PrivilegedBlocks PrivilegedBlocksOf(const Config& config, const ObservationSpec& spec) {
  PrivilegedBlocks blocks;
  blocks.critic = CriticBlocks(config.sac.critic_blocks, spec);
  if (config.sac.critic_blocks && spec.goal_picture &&
      std::ranges::count(blocks.critic, "desired_goal") == 0) {
    throw UsageError(
        "sac.critic_blocks with observation.goal_mode = image: a critic without pixels would "
        "not see the goal; expected 'desired_goal' among them");
  }
  std::set<std::string> wanted(blocks.critic.begin(), blocks.critic.end());
  for (const std::string& text : config.sac.aux) {
    const AuxLabel& label = blocks.labels.emplace_back(LabelOf(text, spec));
    wanted.insert(label.block);
    wanted.insert(label.minus);
  }
  for (const BlockSpec& block : spec.blocks) {
    if (!block.observed && wanted.contains(block.name)) blocks.all.push_back(block.name);
  }
  return blocks;
}

int PrivilegedSize(const Config& config, const ObservationSpec& spec) {
  return BlockPicker::Named(spec, PrivilegedBlocksOf(config, spec).all).size();
}

}  // namespace shoal
