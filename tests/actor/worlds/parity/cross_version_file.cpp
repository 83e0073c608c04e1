// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/cross_version_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "actor/worlds/tools/measurement_reader.h"
#include "actor/worlds/tools/reference_file.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;
using Action = std::array<double, 4>;

struct NamedAction {
  const char* sequence;
  Action action;
};
constexpr NamedAction kConstant[] = {{"zero", {0, 0, 0, 0}},
                                     {"const_x", {1, 0, 0, 0}},
                                     {"const_y", {0, 1, 0, 0}},
                                     {"const_z_close", {0, 0, 1, -1}},
                                     {"const_down_open", {0, 0, -1, 1}}};

// The trajectory beside the file, if there is one.
std::optional<ReferenceTrajectory> FindTrajectory(const std::filesystem::path& file,
                                                  const std::string& task,
                                                  const std::string& sequence) {
  const std::string short_name = task.substr(std::string("Fetch").size());
  const auto path = file.parent_path() / fmt::format("fetch_{}_{}.json", short_name, sequence);
  if (!std::filesystem::exists(path)) return std::nullopt;
  return ReadReference(path);
}

// Reads any one trajectory of the task: all have the same start.
std::optional<ReferenceTrajectory> FindStart(const std::filesystem::path& file,
                                             const std::string& task) {
  for (const NamedAction& constant : kConstant) {
    auto trajectory = FindTrajectory(file, task, constant.sequence);
    if (trajectory) return trajectory;
  }
  return std::nullopt;
}

std::vector<std::array<double, 3>> ReadGrip(const MeasurementReader& sequences,
                                            const std::string& name) {
  const json& positions = sequences.At(name);
  std::vector<std::array<double, 3>> grip;
  if (positions.is_array()) {
    for (const json& position : positions) {
      const bool good = position.is_array() && position.size() == 3 &&
                        std::all_of(position.begin(), position.end(),
                                    [](const json& number) { return number.is_number(); });
      if (!good) break;
      grip.push_back(position.get<std::array<double, 3>>());
    }
  }
  if (grip.empty() || grip.size() != positions.size()) {
    throw sequences.Fault("key '" + sequences.Path(name) + "'", "is not a list of positions");
  }
  return grip;
}

// False when nothing tells the actions.
bool FindActions(const std::filesystem::path& file, CrossVersionSequence* sequence) {
  for (const NamedAction& constant : kConstant) {
    if (sequence->sequence != constant.sequence) continue;
    sequence->actions.assign(sequence->grip.size(), constant.action);
    return true;
  }
  const auto trajectory = FindTrajectory(file, sequence->task, sequence->sequence);
  if (!trajectory || trajectory->steps.size() < sequence->grip.size()) return false;
  for (size_t i = 0; i < sequence->grip.size(); ++i) {
    Action& action = sequence->actions.emplace_back();
    std::ranges::copy(trajectory->steps[i].action, action.begin());
  }
  return true;
}

}  // namespace

CrossVersionFile ReadCrossVersions(const std::filesystem::path& path, const std::string& version) {
  const json document = ReadJson(path);
  const MeasurementReader root(path, document, "");
  const std::string format = root.Text("format");
  if (format != kCrossVersionFormat) {
    throw root.Fault("key 'format'",
                     fmt::format("is '{}'; expected '{}'", format, kCrossVersionFormat));
  }
  const MeasurementReader tasks = root.Object("versions").Object(version);
  CrossVersionFile file;
  for (const auto& [task, unused] : tasks.object().items()) {
    const MeasurementReader entry = tasks.Object(task);
    const MeasurementReader sequences = entry.Object("sequences");
    const auto start = FindStart(path, task);
    if (!start) {
      throw root.Fault("task '" + task + "'",
                       "has no trajectory of a constant action beside the file");
    }
    for (const auto& [name, unused_too] : sequences.object().items()) {
      CrossVersionSequence sequence{.task = task,
                                    .sequence = name,
                                    .version = version,
                                    .initial_grip = entry.Numbers<3>("initial_gripper_xpos"),
                                    .grip = ReadGrip(sequences, name),
                                    .object_xy = start->object_xy,
                                    .desired_goal = start->desired_goal};
      if (FindActions(path, &sequence)) {
        file.sequences.push_back(std::move(sequence));
      } else {
        file.left_out.push_back(fmt::format("{} {}", task, name));
      }
    }
  }
  return file;
}

}  // namespace shoal::worlds
