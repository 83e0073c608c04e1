// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/policy_binding.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/policy/trained_policy.h"
#include "launch/tools/python/observation_properties.h"
#include "launch/tools/python/shape_text.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Bytes = py::array_t<uint8_t, py::array::c_style>;
using Shape = std::vector<py::ssize_t>;

// Arrays of an observation while an action is computed.
struct Arrays {
  Bytes pixels;
  std::vector<std::string> names;
  std::vector<Floats> blocks;
  std::string first;                 // name of the first array; it determines the next two
  std::optional<py::ssize_t> batch;  // N; 1 for a single observation
  bool single = false;               // without the dimension of the batch
};

// Stores how many observations the array holds. `expected` are its dimensions after that of the
// batch. Throws Error if the shape differs, or if other arrays hold another number of observations.
void CheckShape(const std::string& name, const py::array& array, const Shape& expected,
                Arrays* arrays) {
  const std::span<const py::ssize_t> shape(array.shape(), size_t(array.ndim()));
  const bool single = shape.size() == expected.size();
  const auto tail = shape.last(std::min(shape.size(), expected.size()));
  if (shape.size() > expected.size() + 1 || !std::ranges::equal(tail, expected)) {
    throw UsageError("{}: shape {}, expected {} or {}", name, ShapeText(shape), ShapeText(expected),
                     ShapeText(expected, true));
  }
  const py::ssize_t count = single ? 1 : shape.front();
  if (!arrays->batch) {
    arrays->first = name;
    arrays->batch = count;
    arrays->single = single;
  } else if (*arrays->batch != count || arrays->single != single) {
    throw UsageError(
        "{}: shape {} does not go with {}, which is of {}", name, ShapeText(shape), arrays->first,
        arrays->single ? "one observation without N" : fmt::format("N = {}", *arrays->batch));
  }
}

void TakePixels(const ObservationSpec& spec, const py::handle& value, Arrays* arrays) {
  // Refuse floats: pixels scaled to floats would become black when they are converted back.
  const bool bytes = py::isinstance<py::array_t<uint8_t>>(value);
  const Bytes pixels = bytes ? Bytes::ensure(value) : Bytes();
  if (!bytes || !pixels) throw UsageError("pixels: expected a numpy array of uint8, 0..255");
  arrays->pixels = pixels;
  CheckShape("pixels", arrays->pixels, {spec.InputChannels(), spec.height, spec.width}, arrays);
}

void TakeBlock(const ObservationSpec& spec, const std::string& name, const py::handle& value,
               Arrays* arrays) {
  const Floats block = Floats::ensure(value);
  if (!block) throw UsageError("block '{}': expected an array of numbers", name);
  // If a name is not observed, the policy refuses it and lists the observed names.
  if (const auto range = spec.Observed(name)) {
    CheckShape(fmt::format("block '{}'", name), block, {range->size}, arrays);
  }
  arrays->names.push_back(name);
  arrays->blocks.push_back(block);
}

Arrays TakeArrays(const ObservationSpec& spec, const py::dict& observation) {
  Arrays arrays;
  for (const auto& [key, value] : observation) {
    if (!py::isinstance<py::str>(key)) throw UsageError("an observation's keys are names");
    const std::string name = py::cast<std::string>(key);
    if (name == "pixels" && spec.HasPixels()) {
      TakePixels(spec, value, &arrays);
    } else {
      TakeBlock(spec, name, value, &arrays);
    }
  }
  if (spec.HasPixels() && !observation.contains("pixels")) {
    throw UsageError("pixels are missing: uint8 of shape {}",
                     ShapeText(Shape{spec.InputChannels(), spec.height, spec.width}));
  }
  return arrays;
}

py::array_t<float> Act(policy::TrainedPolicy& policy, const py::dict& observation) {
  const Arrays arrays = TakeArrays(policy.spec(), observation);
  std::vector<policy::ObservedBlock> blocks;
  for (size_t i = 0; i < arrays.names.size(); ++i) {
    blocks.push_back({arrays.names[i], {arrays.blocks[i].data(), size_t(arrays.blocks[i].size())}});
  }
  // If there are no arrays, the policy refuses the call and names the missing one.
  const py::ssize_t count = arrays.batch.value_or(1);
  const py::ssize_t size = policy.spec().action_size;
  py::array_t<float> actions(arrays.single ? Shape{size} : Shape{count, size});
  policy.Act({.count = int(count),
              .pixels = {arrays.pixels.data(), size_t(arrays.pixels.size())},
              .blocks = blocks},
             {actions.mutable_data(), size_t(actions.size())});
  return actions;
}

std::string Summary(const policy::TrainedPolicy& policy) {
  return fmt::format("<shoal_rl.Policy {} {}>", policy.description().algorithm,
                     policy.spec().Summary());
}

constexpr char kActMeaning[] =
    "Returns the actions of an evaluation, without exploration, each number in [-1, "
    "1].\n\nobservation: a dict of arrays, `pixels` (K*C, H, W) uint8 and each block (size,), or "
    "each with\nN observations along the first dimension. Returns float32 (A,) or (N, A).";

}  // namespace

void BindPolicy(py::module_& module) {
  using policy::TrainedPolicy;
  py::class_<TrainedPolicy>(module, "Policy", "The policy of a checkpoint.")
      .def(py::init([](const py::object& path) {
             return std::make_unique<TrainedPolicy>(
                 py::cast<std::string>(py::module_::import("os").attr("fspath")(path)));
           }),
           py::arg("path"), "path: a checkpoint's folder, in a run or copied elsewhere.")
      .def("act", &Act, py::arg("observation"), kActMeaning)
      .def_property_readonly(
          "task", [](const TrainedPolicy& policy) { return policy.spec().task; },
          "Task of the policy, such as 'FetchReachDense'.")
      .def_property_readonly(
          "algorithm", [](const TrainedPolicy& policy) { return policy.description().algorithm; },
          "Algorithm that trained the policy, a value of learner.algorithm.")
      .def_property_readonly(
          "action_size", [](const TrainedPolicy& policy) { return policy.spec().action_size; },
          "A, the number of components of an action.")
      .def_property_readonly(
          "pixels", [](const TrainedPolicy& policy) { return PixelShape(policy.spec()); },
          "(K*C, H, W) of one observation, with a goal picture "
          "((K+1)*C, H, W); None without pixels.")
      .def_property_readonly(
          "goal_picture", [](const TrainedPolicy& policy) { return policy.spec().goal_picture; },
          "Whether a picture of the goal reached follows the stack in the pixels.")
      .def_property_readonly(
          "stack", [](const TrainedPolicy& policy) { return policy.spec().stack; },
          "K, the frames of one observation, the oldest first.")
      .def_property_readonly(
          "cameras", [](const TrainedPolicy& policy) { return policy.spec().cameras; },
          "Names of the cameras, in the order of a frame's channels.")
      .def_property_readonly(
          "blocks", [](const TrainedPolicy& policy) { return ObservedBlocks(policy.spec()); },
          "Name and size of each vector that the policy observes beside the pixels.")
      .def("__repr__", &Summary);
}

}  // namespace shoal::python
