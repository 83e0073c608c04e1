// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/observed_numbers.h"

#include <algorithm>
#include <bit>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

// A quiet NaN with Shoal's payload. Copying keeps the payload; arithmetic does not produce it.
constexpr uint64_t kPattern = 0x7ffc'5348'4f41'4c21;
const double kUnwritten = std::bit_cast<double>(kPattern);

bool Unwritten(double number) { return std::bit_cast<uint64_t>(number) == kPattern; }

// "position (2), velocity (2)"
std::string SizesOf(const std::vector<tasks::Block>& blocks) {
  std::string text;
  for (const tasks::Block& block : blocks) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", block.name, block.size());
  }
  return text;
}

size_t SizeOf(const std::vector<tasks::Block>& blocks) {
  size_t size = 0;
  for (const tasks::Block& block : blocks) size += block.components.size();
  return size;
}

}  // namespace

ObservedNumbers::ObservedNumbers(const tasks::Task& task)
    : task_(task), achieved_block_{task.achieved_goal()}, desired_block_{task.desired_goal()} {
  size_t next = kGuard;
  const auto place = [&next](size_t size) {
    const Part part{.first = next, .size = size};
    next += size + kGuard;
    return part;
  };
  state_ = place(SizeOf(task.state_blocks()));
  achieved_ = place(SizeOf(achieved_block_));
  desired_ = place(SizeOf(desired_block_));
  memory_.resize(next);
}

void ObservedNumbers::Read(const World& world) {
  std::ranges::fill(memory_, kUnwritten);
  world.Observe(Writable(state_), Writable(achieved_), Writable(desired_));
  if (!std::ranges::all_of(std::span(memory_).first(kGuard), Unwritten)) {
    throw UsageError("task {}: Observe wrote before the beginning of the state vector",
                     task_.name());
  }
  CheckWritten(state_, task_.state_blocks());
  CheckWritten(achieved_, achieved_block_);
  CheckWritten(desired_, desired_block_);
}

void ObservedNumbers::CheckWritten(const Part& part,
                                   const std::vector<tasks::Block>& blocks) const {
  const std::span<const double> numbers = Numbers(part);
  const std::span<const double> guard = std::span(memory_).subspan(part.first + part.size, kGuard);
  if (!std::ranges::all_of(guard, Unwritten)) ThrowBeyond(part, blocks);
  const auto missing = std::ranges::find_if(numbers, Unwritten);
  if (missing != numbers.end()) {
    ThrowUnwritten(part, blocks, static_cast<size_t>(missing - numbers.begin()));
  }
}

void ObservedNumbers::ThrowBeyond(const Part& part, const std::vector<tasks::Block>& blocks) const {
  const std::span<const double> guard = std::span(memory_).subspan(part.first + part.size, kGuard);
  size_t beyond = kGuard;
  while (beyond > 0 && Unwritten(guard[beyond - 1])) --beyond;
  const std::string at_least = beyond == kGuard ? "at least " : "";
  if (part.size == 0) {
    throw UsageError("task {}: Observe wrote {}{} numbers of {}, of which the goal half has none",
                     task_.name(), at_least, beyond,
                     part.first == state_.first ? "a state vector" : "a goal");
  }
  const tasks::Block& last = blocks.back();
  throw UsageError(
      "task {}: block '{}' has {} numbers in the goal half, Observe wrote {}{} ({} in all; the "
      "goal "
      "half says {} = {})",
      task_.name(), last.name, last.size(), at_least, last.components.size() + beyond,
      part.size + beyond, SizesOf(blocks), part.size);
}

void ObservedNumbers::ThrowUnwritten(const Part& part, const std::vector<tasks::Block>& blocks,
                                     size_t first) const {
  const std::span<const double> numbers = Numbers(part);
  size_t begin = 0;
  for (const tasks::Block& block : blocks) {
    const size_t size = block.components.size();
    if (first >= begin + size) {
      begin += size;
      continue;
    }
    const auto missing = std::ranges::count_if(numbers.subspan(begin, size), Unwritten);
    throw UsageError(
        "task {}: block '{}' has {} numbers in the goal half, Observe wrote {}: {} was never "
        "written (the goal half says {} = {})",
        task_.name(), block.name, size, size - static_cast<size_t>(missing),
        block.components[first - begin].name, SizesOf(blocks), part.size);
  }
  throw UsageError("task {}: number {} was never written by Observe", task_.name(), first);
}

}  // namespace shoal::worlds
