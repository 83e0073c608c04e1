// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/measured_ranges.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace shoal::worlds {

RangeMeter::RangeMeter(const tasks::Task& task)
    : ranges_(static_cast<size_t>(task.observation().size() + 2 * task.goal_size()),
              {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
}

void RangeMeter::OnReset(std::span<const float> numbers) {
  ++episodes_;
  Include(numbers);
}

void RangeMeter::Include(std::span<const float> numbers) {
  ++observations_;
  for (size_t i = 0; i < ranges_.size(); ++i) {
    const double number = numbers[i];
    ranges_[i] = {std::min(ranges_[i].low, number), std::max(ranges_[i].high, number)};
  }
}

std::vector<ConstantNumber> ConstantNumbers(const tasks::Task& task, const RangeMeter& meter) {
  std::vector<ConstantNumber> constant;
  size_t at = 0;
  const auto look = [&](const tasks::Block& block, bool counts) {
    for (const tasks::Component& component : block.components) {
      const MeasuredRange& range = meter.ranges()[at++];
      if (counts && range.low == range.high) {
        constant.push_back({block.name, component.name, range.low});
      }
    }
  };
  const bool moved = meter.observations() > 1;
  for (const tasks::Block& block : task.state_blocks()) look(block, moved);
  look(task.achieved_goal(), moved);
  look(task.desired_goal(), meter.episodes() > 1);
  return constant;
}

std::string ToText(const std::vector<ConstantNumber>& constant, int observations) {
  std::string text;
  for (const ConstantNumber& number : constant) {
    text += fmt::format(
        "  warning: {} of block '{}' was {:.4g} in all of {} observations: does the physics half "
        "write its value?\n",
        number.name, number.block, number.value, observations);
  }
  return text;
}

nlohmann::ordered_json ToJson(const std::vector<ConstantNumber>& constant) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ConstantNumber& number : constant) {
    list.push_back({{"block", number.block}, {"name", number.name}, {"value", number.value}});
  }
  return list;
}

}  // namespace shoal::worlds
