// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_registry.h"

#include <fmt/ranges.h>

#include <deque>
#include <utility>

#include "common/base/error.h"
#include "common/base/nearest_name.h"
#include "common/tasks/control_tasks.h"
#include "common/tasks/fetch_tasks.h"
#include "common/tasks/hopper_tasks.h"
#include "common/tasks/task_check.h"

namespace shoal::tasks {
namespace {

// A deque, so that adding a task does not move the others.
std::deque<Task>& AllTasks() {
  static std::deque<Task> tasks = [] {
    std::deque<Task> all;
    for (auto family : {FetchTasks, HopperTasks, ControlTasks}) {
      for (Task& task : family()) all.push_back(std::move(task));
    }
    return all;
  }();
  return tasks;
}

}  // namespace

const Task& FindTask(const std::string& name) {
  for (const Task& task : AllTasks()) {
    if (task.name() == name) return task;
  }
  const std::vector<std::string> names = TaskNames();
  throw UsageError("unknown task '{}'; tasks: {}{}", name, fmt::join(names, ", "),
                   NearestHint(name, names));
}

Task FindTask(const std::string& name, double distance_threshold) {
  const Task& task = FindTask(name);
  return distance_threshold > 0 ? task.WithThreshold(distance_threshold) : task;
}

std::vector<std::string> TaskNames() {
  std::vector<std::string> names;
  for (const Task& task : AllTasks()) names.push_back(task.name());
  return names;
}

void AddTask(Task task) {
  CheckPlayable(task);
  for (const std::string& name : TaskNames()) {
    if (name == task.name()) throw UsageError("there is a task '{}' already", name);
  }
  AllTasks().push_back(std::move(task));
}

}  // namespace shoal::tasks
