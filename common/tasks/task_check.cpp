// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_check.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "common/base/error.h"

namespace shoal::tasks {
namespace {

constexpr size_t kLongestName = 64;
constexpr int kLongestEpisode = 1'000'000'000;

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool IsBlockName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && IsLetter(name[0]) && name.back() != '.' &&
         std::ranges::all_of(name, [](char c) { return IsLetter(c) || IsDigit(c) || c == '.'; });
}

// Whether the configuration's `task` takes the name. Run folders are named after the task.
bool IsTaskName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && (IsLetter(name[0]) || IsDigit(name[0])) &&
         std::ranges::all_of(
             name, [](char c) { return IsLetter(c) || IsDigit(c) || c == '.' || c == '-'; });
}

// Text for messages. Characters that would break a line become '?'.
std::string Shown(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, '?');
  return text.size() > kLongestName ? text.substr(0, kLongestName) + "..." : text;
}

void CheckComponents(const std::string& task, const std::string& where,
                     const std::vector<Component>& components) {
  for (const Component& component : components) {
    if (component.name.empty())
      throw UsageError("task '{}': a number of {} has no name", task, where);
    if (Shown(component.name) != component.name) {
      throw UsageError(
          "task '{}': {}: '{}' is no name of a number: expected one line of at most {}", task,
          where, Shown(component.name), kLongestName);
    }
    if (component.low <= component.high) continue;  // false for NaN
    throw UsageError(
        "task '{}': {}: {} has bounds [{}, {}]; expected low <= high, infinite for none", task,
        where, component.name, component.low, component.high);
  }
}

void CheckBlock(const std::string& task, const Block& block) {
  if (!IsBlockName(block.name)) {
    throw UsageError(
        "task '{}': '{}' is no name of a block: expected letters, digits, underscores and dots, "
        "beginning with a letter or '_', not ending with a dot, at most {}",
        task, Shown(block.name), kLongestName);
  }
  if (block.components.empty()) {
    throw UsageError("task '{}': block '{}' has no numbers", task, block.name);
  }
  CheckComponents(task, "block '" + block.name + "'", block.components);
}

void CheckSize(const std::string& task, const std::string& what, size_t size, int most) {
  if (size <= static_cast<size_t>(most)) return;
  throw UsageError("task '{}': {} has {} numbers; expected at most {}", task, what, size, most);
}

void CheckGoals(const Task::Description& task) {
  const int achieved = task.achieved_goal.size(), desired = task.desired_goal.size();
  if (achieved != desired) {
    throw UsageError(
        "task '{}': goals of different size: block '{}' has {} numbers, block '{}' has {}",
        task.name, Shown(task.achieved_goal.name), achieved, Shown(task.desired_goal.name),
        desired);
  }
  if (desired == 0) return;
  CheckBlock(task.name, task.achieved_goal);
  CheckBlock(task.name, task.desired_goal);
  CheckSize(task.name, "a goal", task.desired_goal.components.size(), kMostNumbers);
  if (task.distance_threshold >= 0 && std::isfinite(task.distance_threshold)) return;
  throw UsageError("task '{}': distance_threshold is {} m; expected a finite number of at least 0",
                   task.name, task.distance_threshold);
}

void CheckBlockNames(const Task::Description& task) {
  std::set<std::string> names;
  const auto take = [&](const Block& block) {
    if (names.insert(block.name).second) return;
    throw UsageError("task '{}': two blocks have the name '{}'", task.name, Shown(block.name));
  };
  if (task.desired_goal.size() > 0) {
    take(task.achieved_goal);
    take(task.desired_goal);
  }
  for (const Block& block : task.observation) take(block);
}

}  // namespace

void CheckDescription(const Task::Description& task) {
  if (!IsTaskName(task.name)) {
    throw UsageError(
        "'{}' is no name of a task: expected letters, digits, '_', '-' and '.', beginning with a "
        "letter or a digit, at most {}",
        Shown(task.name), kLongestName);
  }
  if (task.episode_length < 1 || task.episode_length > kLongestEpisode) {
    throw UsageError("task '{}': episode_length is {} control steps; expected 1 to {}", task.name,
                     task.episode_length, kLongestEpisode);
  }
  if (task.action_repeat < 1 || task.action_repeat > task.episode_length) {
    throw UsageError("task '{}': action_repeat is {}; expected 1 to the episode_length of {}",
                     task.name, task.action_repeat, task.episode_length);
  }
  CheckSize(task.name, "the action", task.action.size(), kMostActions);
  CheckComponents(task.name, "the action", task.action);
  size_t state = 0;
  for (const Block& block : task.observation) {
    CheckBlock(task.name, block);
    state += block.components.size();
  }
  CheckSize(task.name, "the state vector", state, kMostNumbers);
  CheckGoals(task);
  CheckBlockNames(task);
}

void CheckPlayable(const Task& task) {
  if (task.action_size() == 0) {
    throw UsageError("task '{}': the action has no numbers; expected at least 1", task.name());
  }
  if (task.world().empty()) {
    throw UsageError("task '{}': it names no physics half (Description::world)", task.name());
  }
}

}  // namespace shoal::tasks
