// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/environment_binding.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/physics_library.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/config_io.h"
#include "common/tasks/task_registry.h"
#include "launch/tools/python/observation_properties.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

constexpr char kSource[] = "shoal_rl.make";

// Loads the tasks of `library`, NAME.so, from NAME_python.so in the same folder, which was built
// for this module (common/cmake/task_library.cmake).
void LoadPythonTasks(const std::string& library) {
  if (library.empty()) return;
  std::filesystem::path built = library;
  built.replace_filename(built.stem().string() + "_python" + built.extension().string());
  worlds::LoadTasks(built.string());
}

// `keys`: keys of a configuration, as JSON. Defaults: the first cameras of the task; without
// pixels, all blocks are observed.
Config ReadKeys(const std::string& task_name, const std::string& keys) {
  Config config;
  ObservationConfig& observation = config.observation;
  observation.cameras.clear();
  ApplyJson(ParseStrictJson(keys, kSource), kSource, &config);
  config.task = task_name;
  LoadPythonTasks(config.task_library);
  const tasks::Task& task = tasks::FindTask(task_name);
  if (observation.pixels && observation.cameras.empty()) {
    const auto world = worlds::MakeWorld(task.world(), {config.model, config.physics});
    observation.cameras = {worlds::DefaultCamera(*world).name};
  }
  if (!observation.pixels && !observation.proprioception && observation.goal_mode == "none") {
    observation.proprioception = true;
    if (task.goal_size() > 0) observation.goal_mode = "both";
  }
  Validate(config);
  return config;
}

// An environment with its frame stack. One episode at a time.
class PlayedEnvironment {
 public:
  PlayedEnvironment(const std::string& task, const std::string& keys)
      : PlayedEnvironment(ReadKeys(task, keys)) {}

  const ObservationSpec& spec() const { return environment_->spec(); }
  bool has_success() const { return tasks::FindTask(spec().task).has_success(); }

  // Starts episode `episode` of the sequence of `seed`. Returns observation and distance.
  py::tuple Reset(uint64_t seed, uint64_t episode) {
    running_ = false;
    const float distance = environment_->Reset(
        StreamKey(seed, StreamRole::kEvalEnvironment, episode), {frame_, vector_});
    const std::span<const uint8_t> goal = environment_->goal_picture();
    std::ranges::copy(goal, stack_.end() - std::ptrdiff_t(goal.size()));
    for (size_t k = 0; k < size_t(spec().stack); ++k) {
      std::ranges::copy(frame_, stack_.begin() + std::ptrdiff_t(k * frame_.size()));
    }
    running_ = true;
    distance_ = distance;
    return py::make_tuple(Observation(), distance);
  }

  // Returns observation, reward, terminated, truncated, success, distance and, if the step was
  // faulty, the reason. A faulty step truncates the episode at the previous observation, which is
  // returned again.
  py::tuple Step(const py::object& action) {
    if (!running_) throw UsageError("step: no episode is running; reset() starts one");
    const auto numbers =
        py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(action);
    if (!numbers || numbers.ndim() != 1 || numbers.size() != spec().action_size) {
      throw UsageError("step: expected an action of {} numbers", spec().action_size);
    }
    for (py::ssize_t i = 0; i < numbers.size(); ++i) {
      // No step has been made, so the episode continues. The comparison also refuses NaN.
      if (std::fabs(numbers.at(i)) <= 1) continue;
      throw UsageError("step: number {} of the action is {}, expected -1 to 1", i, numbers.at(i));
    }
    running_ = false;  // stays false if the step throws
    StepResult result;
    try {
      result = environment_->Step({numbers.data(), size_t(numbers.size())}, {frame_, vector_});
    } catch (const worlds::EpisodeFault& fault) {
      return py::make_tuple(Observation(), 0.0F, false, true, false, distance_, fault.what());
    }
    distance_ = result.distance;
    running_ = !result.terminated && !result.truncated;
    if (!frame_.empty()) {
      const auto frame = std::ptrdiff_t(frame_.size());
      const auto end = stack_.begin() + frame * spec().stack;  // a goal picture stays last
      std::rotate(stack_.begin(), stack_.begin() + frame, end);
      std::ranges::copy(frame_, end - frame);
    }
    return py::make_tuple(Observation(), result.reward, result.terminated, result.truncated,
                          result.success, result.distance, py::none());
  }

  double simulated_seconds() const { return environment_->simulated_seconds(); }

 private:
  using StepResult = worlds::StepResult;

  explicit PlayedEnvironment(const Config& config)
      : environment_(worlds::MakeEnvironment(
            config,
            config.observation.pixels ? worlds::MakeRenderContext(config.observation) : nullptr)),
        frame_(size_t(spec().FrameBytes())),
        stack_(size_t(spec().InputBytes())),
        vector_(size_t(spec().RecordedVectorSize())) {}

  // The observation of a policy: the stack and the observed blocks, each in a separate array.
  py::dict Observation() const {
    py::dict observation;
    if (spec().HasPixels()) {
      py::array_t<uint8_t> pixels(
          std::vector<py::ssize_t>{spec().InputChannels(), spec().height, spec().width});
      std::ranges::copy(stack_, pixels.mutable_data());
      observation["pixels"] = pixels;
    }
    for (const BlockSpec& block : spec().blocks) {
      if (!block.observed) continue;
      // Copy the numbers: made from length and pointer, pybind11 before 2.12 misreads NumPy 2's
      // item size.
      py::array_t<float> numbers(std::vector<py::ssize_t>{block.size});
      std::copy_n(vector_.begin() + spec().Recorded(block.name)->first, block.size,
                  numbers.mutable_data());
      observation[py::str(block.name)] = numbers;
    }
    return observation;
  }

  std::unique_ptr<worlds::Environment> environment_;
  std::vector<uint8_t> frame_;  // (C, H, W), the latest
  std::vector<uint8_t> stack_;  // (I, H, W), the oldest frame first, a goal picture last
  std::vector<float> vector_;   // (R)
  float distance_ = 0;          // after the last observation
  bool running_ = false;        // between a reset and the end of its episode
};

}  // namespace

void BindEnvironment(py::module_& module) {
  using Played = PlayedEnvironment;
  py::class_<Played>(module, "Environment")
      .def(py::init<const std::string&, const std::string&>(), py::arg("task"), py::arg("keys"))
      .def("reset", &Played::Reset, py::arg("seed"), py::arg("episode"))
      .def("step", &Played::Step, py::arg("action"))
      .def_property_readonly("pixels", [](const Played& e) { return PixelShape(e.spec()); })
      .def_property_readonly("blocks", [](const Played& e) { return ObservedBlocks(e.spec()); })
      .def_property_readonly("stack", [](const Played& e) { return e.spec().stack; })
      .def_property_readonly("goal_picture", [](const Played& e) { return e.spec().goal_picture; })
      .def_property_readonly("cameras", [](const Played& e) { return e.spec().cameras; })
      .def_property_readonly("action_size", [](const Played& e) { return e.spec().action_size; })
      .def_property_readonly("has_success", &Played::has_success)
      .def_property_readonly("simulated_seconds", &Played::simulated_seconds);
  module.def("tasks", &tasks::TaskNames, "Names of the tasks that make() knows.");
}

}  // namespace shoal::python
