#include "actor/worlds/tools/reference_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "vrl-ref-1";
constexpr const char* kReplayable = "FetchReach-v4";
constexpr size_t kObservationSize = 10, kActionSize = 4, kMostSteps = 100'000;

// One JSON object of the file, knowing the path of keys that leads to it.
class Reader {
 public:
  Reader(const std::filesystem::path& file, const json& object, std::string where)
      : file_(file), object_(object), where_(std::move(where)) {
    if (!object.is_object()) throw Fault(where_.empty() ? "the file" : where_, "is not an object");
  }

  Error Fault(const std::string& what, const std::string& problem) const {
    return RuntimeError("reference file '{}': {} {}", file_.string(), what, problem);
  }

  std::string Path(const std::string& key) const {
    return where_.empty() ? key : where_ + "." + key;
  }

  const json& At(const std::string& key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) throw Fault("key '" + Path(key) + "'", "is missing");
    return *found;
  }

  Reader Object(const std::string& key) const { return Reader(file_, At(key), Path(key)); }

  std::string Text(const std::string& key) const {
    const json& value = At(key);
    if (!value.is_string()) throw Fault("key '" + Path(key) + "'", "is not a string");
    return value.get<std::string>();
  }

  double Number(const std::string& key) const {
    const json& value = At(key);
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      throw Fault("key '" + Path(key) + "'", "is not a finite number");
    }
    return value.get<double>();
  }

  std::vector<double> Numbers(const std::string& key, size_t size) const {
    const json& value = At(key);
    const bool good = value.is_array() && value.size() == size &&
                      std::all_of(value.begin(), value.end(), [](const json& element) {
                        return element.is_number() && std::isfinite(element.get<double>());
                      });
    if (!good)
      throw Fault("key '" + Path(key) + "'", fmt::format("is not {} finite numbers", size));
    return value.get<std::vector<double>>();
  }

  template <size_t kSize>
  std::array<double, kSize> Numbers(const std::string& key) const {
    std::array<double, kSize> numbers{};
    std::ranges::copy(Numbers(key, kSize), numbers.begin());
    return numbers;
  }

 private:
  const std::filesystem::path& file_;
  const json& object_;
  std::string where_;
};

ReferenceState ReadState(const Reader& from, size_t joints) {
  ReferenceState state;
  state.observation = from.Numbers("obs", kObservationSize);
  state.achieved_goal = from.Numbers<3>("achieved_goal");
  state.qpos = from.Numbers("qpos", joints);
  state.qvel = from.Numbers("qvel", joints);
  state.grip_quaternion = from.Numbers<4>("grip_xquat");
  return state;
}

ReferenceStep ReadStep(const Reader& from, size_t joints) {
  ReferenceStep step;
  step.action = from.Numbers("action", kActionSize);
  for (const double component : step.action) {
    if (std::fabs(component) > 1) {
      throw from.Fault("key '" + from.Path("action") + "'", "has a component outside [-1, 1]");
    }
  }
  step.state = ReadState(from, joints);
  step.distance = from.Number("distance");
  step.reward_sparse = from.Number("reward_sparse");
  step.reward_dense = from.Number("reward_dense");
  step.success = from.Number("is_success") != 0;
  return step;
}

std::vector<std::string> ReadNames(const Reader& from, const std::string& key) {
  const json& value = from.At(key);
  const bool good = value.is_array() && !value.empty() &&
                    std::all_of(value.begin(), value.end(),
                                [](const json& element) { return element.is_string(); });
  if (!good) throw from.Fault("key '" + key + "'", "is not a list of names");
  return value.get<std::vector<std::string>>();
}

}  // namespace

ReferenceTrajectory ReadReference(const std::filesystem::path& path) {
  json document;
  try {
    document = json::parse(ReadFile(path));
  } catch (const json::exception& problem) {
    throw RuntimeError("reference file '{}' is not JSON: {}", path.string(), problem.what());
  }
  const Reader root(path, document, "");
  const std::string format = root.Text("format");
  if (format != kFormat) {
    throw root.Fault("key 'format'", fmt::format("is '{}'; expected '{}'", format, kFormat));
  }
  ReferenceTrajectory trajectory;
  trajectory.environment = root.Text("env");
  if (trajectory.environment != kReplayable) {
    throw root.Fault("key 'env'", fmt::format("is '{}', which cannot be replayed; known: {}",
                                              trajectory.environment, kReplayable));
  }
  trajectory.sequence = root.Text("sequence");
  trajectory.initial_grip = root.Numbers<3>("initial_gripper_xpos");
  trajectory.desired_goal = root.Numbers<3>("desired_goal");
  trajectory.joint_names = ReadNames(root, "joint_names");
  const size_t joints = trajectory.joint_names.size();
  trajectory.reset = ReadState(root.Object("reset"), joints);

  const json& steps = root.At("trajectory");
  if (!steps.is_array() || steps.empty() || steps.size() > kMostSteps) {
    throw root.Fault("key 'trajectory'", "is not a list of steps");
  }
  for (size_t i = 0; i < steps.size(); ++i) {
    const Reader step(path, steps[i], fmt::format("trajectory[{}]", i));
    trajectory.steps.push_back(ReadStep(step, joints));
  }
  return trajectory;
}

}  // namespace shoal::worlds
