// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/environment_description.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::tasks {
namespace {

using nlohmann::json;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kLeastSide = 8;            // pixels of an image
constexpr size_t kLongestTaskName = 50;  // without a prefix
constexpr char kLibrary[] = ".so:";
constexpr char kWorld[] = "environment";  // physics half: the process that runs the environment

struct TypeRow {
  const char* name;
  ElementType type;
  size_t bytes;
};
constexpr TypeRow kTypes[] = {
    {"float32", ElementType::kFloat32, 4}, {"float64", ElementType::kFloat64, 8},
    {"uint8", ElementType::kUint8, 1},     {"uint16", ElementType::kUint16, 2},
    {"uint32", ElementType::kUint32, 4},   {"int8", ElementType::kInt8, 1},
    {"int16", ElementType::kInt16, 2},     {"int32", ElementType::kInt32, 4},
    {"int64", ElementType::kInt64, 8}};

const TypeRow& RowOf(ElementType type) {
  const auto* const row = std::ranges::find(kTypes, type, &TypeRow::type);
  CHECK(row != std::end(kTypes)) << int(type);
  return *row;
}

ElementType TypeNamed(const std::string& name, const std::string& array) {
  const auto* const row = std::ranges::find(kTypes, name, &TypeRow::name);
  if (row != std::end(kTypes)) return row->type;
  std::vector<std::string_view> known;
  for (const TypeRow& type : kTypes) known.push_back(type.name);
  throw UsageError("environment: '{}' has elements of type {}; expected {}", array, name,
                   fmt::join(known, ", "));
}

std::vector<double> BoundsFromJson(const json& bound, double infinite) {
  std::vector<double> bounds;
  for (const json& number : bound.is_array() ? bound : json::array({bound})) {
    bounds.push_back(number.is_null() ? infinite : number.get<double>());
  }
  return bounds;
}

json BoundsToJson(const std::vector<double>& bounds) {
  json numbers = json::array();
  for (const double bound : bounds) {
    numbers.push_back(std::isinf(bound) ? json(nullptr) : json(bound));
  }
  return numbers.size() == 1 ? numbers[0] : numbers;
}

ArraySpace SpaceFromJson(const json& object, const std::string& name) {
  ArraySpace space{.name = name,
                   .shape = object.at("shape").get<std::vector<int>>(),
                   .type = TypeNamed(object.at("dtype").get<std::string>(), name),
                   .low = BoundsFromJson(object.at("low"), -kInfinite),
                   .high = BoundsFromJson(object.at("high"), kInfinite)};
  if (std::ranges::any_of(space.shape, [](int side) { return side < 1; })) {
    throw UsageError("environment: '{}' has an empty dimension; expected at least one element",
                     name);
  }
  for (const std::vector<double>* bounds : {&space.low, &space.high}) {
    if (bounds->size() == 1 || bounds->size() == size_t(space.size())) continue;
    throw UsageError("environment: '{}' has {} elements and {} bounds; expected one for each", name,
                     space.size(), bounds->size());
  }
  return space;
}

json SpaceToJson(const ArraySpace& space) {
  return {{"shape", space.shape},
          {"dtype", NameOf(space.type)},
          {"low", BoundsToJson(space.low)},
          {"high", BoundsToJson(space.high)}};
}

void CheckAction(const ArraySpace& action) {
  for (int i = 0; i < action.size(); ++i) {
    if (std::isfinite(action.Low(i)) && std::isfinite(action.High(i)) &&
        action.Low(i) < action.High(i)) {
      continue;
    }
    throw UsageError(
        "environment: number {} of the action has the bounds [{}, {}]; expected finite bounds, "
        "which Shoal's [-1, 1] is mapped to (gymnasium.wrappers.RescaleAction sets them)",
        i, action.Low(i), action.High(i));
  }
}

void CheckNames(const std::vector<ArraySpace>& observation) {
  std::set<std::string> names;
  for (const ArraySpace& space : observation) {
    if (names.insert(space.name).second) continue;
    throw UsageError("environment: two arrays of the observation have the name '{}'", space.name);
  }
}

RewardKind RewardFromJson(const std::string& name) {
  if (name == "sparse") return RewardKind::kSparse;
  if (name == "dense") return RewardKind::kDense;
  throw UsageError("environment: goal reward is '{}'; expected sparse or dense", name);
}

EnvironmentDescription Parse(const json& object) {
  if (object.at("schema") != kEnvironmentSchema) {
    throw UsageError("environment: schema is {}; expected '{}'", object.at("schema").dump(),
                     kEnvironmentSchema);
  }
  EnvironmentDescription environment;
  object.at("id").get_to(environment.id);
  object.at("task").get_to(environment.task);
  object.at("episode_steps").get_to(environment.episode_steps);
  environment.action = SpaceFromJson(object.at("action"), "action");
  for (const json& space : object.at("observation")) {
    environment.observation.push_back(SpaceFromJson(space, space.at("name").get<std::string>()));
  }
  object.at("success").get_to(environment.success);
  if (object.contains("goal")) {
    const json& goal = object.at("goal");
    environment.goal = {.reward = RewardFromJson(goal.at("reward").get<std::string>()),
                        .threshold = goal.at("threshold").get<double>()};
  }
  environment.no_goal = object.value("no_goal", "");
  return environment;
}

bool IsGoal(const EnvironmentDescription& environment, const ArraySpace& space) {
  return environment.goal && (space.name == kAchievedGoal || space.name == kDesiredGoal);
}

Block BlockOf(const ArraySpace& space) {
  Block block{.name = space.name, .components = {}};
  for (int i = 0; i < space.size(); ++i) {
    block.components.push_back(
        {.name = fmt::format("{}_{}", space.name, i),
         .meaning = fmt::format("number {} of the environment's '{}'", i, space.name),
         .low = space.Low(i),
         .high = space.High(i)});
  }
  return block;
}

}  // namespace

const char* NameOf(ElementType type) { return RowOf(type).name; }

size_t BytesOf(ElementType type) { return RowOf(type).bytes; }

int ArraySpace::size() const {
  int size = 1;
  for (const int side : shape) size *= side;
  return size;
}

double ArraySpace::Low(int element) const {
  return low.size() == 1 ? low[0] : low[size_t(element)];
}

double ArraySpace::High(int element) const {
  return high.size() == 1 ? high[0] : high[size_t(element)];
}

std::optional<ImageLayout> ImageLayoutOf(const ArraySpace& space) {
  if (space.type != ElementType::kUint8) return std::nullopt;
  const std::vector<int>& shape = space.shape;
  if (shape.size() < 2) return std::nullopt;
  const auto is_channels = [](int size) { return size == 1 || size == 3; };
  if (shape.size() == 2 && shape[0] >= kLeastSide && shape[1] >= kLeastSide) {
    return ImageLayout{.height = shape[0], .width = shape[1], .channels = 1};
  }
  if (shape.size() == 3 && is_channels(shape[2]) && shape[0] >= kLeastSide &&
      shape[1] >= kLeastSide) {
    return ImageLayout{.height = shape[0], .width = shape[1], .channels = shape[2]};
  }
  if (shape.size() == 3 && is_channels(shape[0]) && shape[1] >= kLeastSide &&
      shape[2] >= kLeastSide) {
    return ImageLayout{
        .height = shape[1], .width = shape[2], .channels = shape[0], .channels_first = true};
  }
  throw UsageError(
      "environment: '{}' is uint8 of shape {}; expected an image HxWxC, CxHxW or HxW with 1 or 3 "
      "channels and at least {} pixels a side; stacks of frames are Shoal's (observation.stack)",
      space.name, fmt::join(shape, "x"), kLeastSide);
}

const ArraySpace* EnvironmentDescription::Find(const std::string& name) const {
  const auto found = std::ranges::find(observation, name, &ArraySpace::name);
  return found == observation.end() ? nullptr : &*found;
}

void EnvironmentDescription::TakeFindings(const EnvironmentDescription& of) {
  success = of.success;
  goal = of.goal;
  no_goal = of.no_goal;
}

std::string TaskNameOf(const std::string& id) {
  const size_t colon = id.rfind(':');
  std::string name = id.substr(colon == std::string::npos ? 0 : colon + 1);
  // An environment from a file has the file's stem before its name.
  for (const char* ending : {".py:", kLibrary}) {
    const size_t file = id.rfind(ending);
    if (file == std::string::npos) continue;
    const size_t slash = id.rfind('/', file);
    const size_t stem = slash == std::string::npos ? 0 : slash + 1;
    name = fmt::format("{}.{}", id.substr(stem, file - stem), name);
  }
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_') c = '-';
  }
  name.erase(0, name.find_first_not_of(".-_"));
  name = name.substr(0, kLongestTaskName);
  const std::vector<std::string> names = TaskNames();
  const bool taken = std::ranges::count(names, name) > 0 && FindTask(name).world() != kWorld;
  return name.empty() || taken ? fmt::format("environment.{}", name) : name;
}

std::string LibraryOf(const std::string& id) {
  const size_t file = id.rfind(kLibrary);
  return file == std::string::npos ? "" : id.substr(0, file + std::string(kLibrary).size() - 1);
}

EnvironmentDescription EnvironmentFromJson(const json& object) {
  EnvironmentDescription environment;
  try {
    environment = Parse(object);
  } catch (const json::exception& e) {
    throw UsageError("environment: {}", e.what());
  }
  CheckAction(environment.action);
  CheckNames(environment.observation);
  if (environment.observation.empty()) {
    throw UsageError("environment: the observation has no arrays; expected at least one");
  }
  TaskOf(environment);  // refuses bad names and sizes
  return environment;
}

json ToJson(const EnvironmentDescription& environment) {
  json observation = json::array();
  for (const ArraySpace& space : environment.observation) {
    json object = SpaceToJson(space);
    object["name"] = space.name;
    observation.push_back(std::move(object));
  }
  json object{{"schema", kEnvironmentSchema},
              {"id", environment.id},
              {"task", environment.task},
              {"episode_steps", environment.episode_steps},
              {"action", SpaceToJson(environment.action)},
              {"observation", std::move(observation)},
              {"success", environment.success}};
  if (environment.goal) {
    const bool dense = environment.goal->reward == RewardKind::kDense;
    object["goal"] = {{"reward", dense ? "dense" : "sparse"},
                      {"threshold", environment.goal->threshold}};
  }
  if (!environment.no_goal.empty()) object["no_goal"] = environment.no_goal;
  return object;
}

Task TaskOf(const EnvironmentDescription& environment) {
  Task::Description task;
  task.name = environment.task;
  task.world = kWorld;
  task.episode_length = environment.episode_steps > 0 ? environment.episode_steps : kNoTimeLimit;
  for (int i = 0; i < environment.action.size(); ++i) {
    task.action.push_back({.name = fmt::format("action_{}", i),
                           .meaning = fmt::format("-1 = {}, 1 = {}", environment.action.Low(i),
                                                  environment.action.High(i)),
                           .low = -1,
                           .high = 1});
  }
  for (const ArraySpace& space : environment.observation) {
    if (ImageLayoutOf(space)) continue;
    if (!IsGoal(environment, space)) task.observation.push_back(BlockOf(space));
  }
  task.reports_success = environment.success;
  task.physics_reward = "the environment's own";
  task.no_goals = environment.no_goal;
  if (environment.goal) {
    const ArraySpace *achieved = environment.Find(kAchievedGoal),
                     *desired = environment.Find(kDesiredGoal);
    if (achieved == nullptr || desired == nullptr) {
      throw UsageError("environment: a goal without the arrays {} and {}", kAchievedGoal,
                       kDesiredGoal);
    }
    task.achieved_goal = BlockOf(*achieved);
    task.desired_goal = BlockOf(*desired);
    task.reward = environment.goal->reward;
    task.distance_threshold = environment.goal->threshold;
  }
  return Task(std::move(task));
}

void AddEnvironmentTask(const std::string& environment) {
  if (environment.empty()) return;
  static std::set<std::string> added;
  if (added.contains(environment)) return;
  const json object = ParseBoundedJson<json>(environment);
  AddTask(TaskOf(EnvironmentFromJson(object)));
  added.insert(environment);
}

}  // namespace shoal::tasks
