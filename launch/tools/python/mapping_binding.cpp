// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/mapping_binding.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "actor/hosted/action_mapping.h"
#include "actor/hosted/observation_mapping.h"
#include "common/base/bounded_json.h"
#include "common/base/error.h"
#include "common/policy/checkpoint_policy.h"
#include "common/spec/frame_stack.h"
#include "common/tasks/environment_description.h"
#include "launch/tools/python/space_array.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

ObservationSpec SpecOfPolicy(const std::string& checkpoint) {
  ObservationSpec spec = policy::ReadCheckpointPolicy(checkpoint).description.spec;
  if (!spec.environment.empty()) return spec;
  throw UsageError(
      "'{}' is a policy of Shoal's own task {}; expected a policy of a Python environment: "
      "shoal_rl.make(policy.task) makes the environment of a task",
      checkpoint, spec.task);
}

class Mapping {
 public:
  explicit Mapping(const std::string& checkpoint)
      : spec_(SpecOfPolicy(checkpoint)),
        description_(
            tasks::EnvironmentFromJson(ParseBoundedJson<nlohmann::json>(spec_.environment))),
        mapping_(description_, spec_),
        observed_(BlockPicker::Observed(spec_)),
        vector_(size_t(spec_.RecordedVectorSize())),
        seen_(size_t(spec_.VectorSize())),
        frame_(size_t(spec_.FrameBytes())),
        pixels_(size_t(spec_.InputBytes())),
        stack_(pixels_, spec_.FrameBytes()) {
    for (const tasks::ArraySpace& space : description_.observation) {
      spaces_.emplace_back(description_.id, space);
      unseen_.emplace_back(size_t(space.size()) * tasks::BytesOf(space.type));
    }
  }

  const std::string& environment() const { return description_.id; }

  // `arrays`: name -> array. `first`: the first observation of an episode.
  py::dict Observe(const py::dict& arrays, bool first) {
    const std::vector<py::array> held = Take(arrays);
    std::vector<const void*> places;
    for (size_t i = 0; i < held.size(); ++i) {
      places.push_back(held[i] ? held[i].data() : unseen_[i].data());
    }
    steps_ = first ? 0 : steps_ + 1;
    mapping_.ReadVector(places, steps_, vector_);
    if (spec_.HasPixels()) {
      mapping_.ReadFrame(places, frame_);
      if (first) {
        stack_.Reset(frame_);
      } else {
        stack_.Push(frame_);
      }
    }
    return Inputs();
  }

  py::array Action(const py::array_t<float, py::array::c_style | py::array::forcecast>& action) {
    const tasks::ArraySpace& space = description_.action;
    if (action.ndim() != 1 || action.size() != space.size()) {
      throw UsageError("action: {} numbers in {} dimension(s); expected {} in one: one action",
                       action.size(), action.ndim(), space.size());
    }
    std::vector<double> mapped(size_t(space.size()));
    hosted::MapAction(space, {action.data(), size_t(action.size())}, mapped);
    return ActionArray(space, {space.shape.begin(), space.shape.end()}, mapped);
  }

 private:
  bool IsSeen(const std::string& name) const {
    return std::ranges::count(spec_.cameras, name) > 0 || spec_.Observed(name).has_value();
  }

  // Returns arrays in the description's order, without arrays that the policy does not see.
  std::vector<py::array> Take(const py::dict& arrays) const {
    std::vector<py::array> held;
    for (const SpaceArray& space : spaces_) {
      const std::string& name = space.space().name;
      if (!IsSeen(name)) {
        held.push_back(py::reinterpret_steal<py::array>(py::handle()));
      } else if (arrays.contains(name)) {
        held.push_back(space.Take("the observation", arrays[name.c_str()]));
      } else {
        throw UsageError("environment {}: the observation has no '{}', which the policy sees",
                         description_.id, name);
      }
    }
    return held;
  }

  // Returns a copy of the inputs in the form that Policy.act takes.
  py::dict Inputs() {
    py::dict inputs;
    if (spec_.HasPixels()) {
      py::array_t<uint8_t> pixels({spec_.InputChannels(), spec_.height, spec_.width});
      std::ranges::copy(pixels_, pixels.mutable_data());
      inputs["pixels"] = pixels;
    }
    observed_.Copy(vector_, seen_);
    for (const BlockSpec& block : spec_.blocks) {
      const auto range = spec_.Observed(block.name);
      if (!range) continue;
      // The constructor takes a shape: pybind11 before 2.12 computes the strides for a count from a
      // field that NumPy 2 has moved, and every element would be the first.
      py::array_t<float> numbers(std::vector<py::ssize_t>{range->size});
      std::copy_n(seen_.data() + range->first, range->size, numbers.mutable_data());
      inputs[block.name.c_str()] = numbers;
    }
    return inputs;
  }

  const ObservationSpec spec_;
  const tasks::EnvironmentDescription description_;
  hosted::ObservationMapping mapping_;
  const BlockPicker observed_;
  std::vector<SpaceArray> spaces_;
  std::vector<std::vector<uint8_t>> unseen_;  // replace arrays that the policy does not see
  std::vector<float> vector_;                 // (R)
  std::vector<float> seen_;                   // (V)
  std::vector<uint8_t> frame_, pixels_;       // (C, H, W), (I, H, W)
  FrameStack stack_;                          // in pixels_
  int64_t steps_ = 0;
};

}  // namespace

void BindMapping(py::module_& module) {
  py::class_<Mapping>(module, "Mapping")
      .def(py::init([](const py::object& path) {
             return std::make_unique<Mapping>(
                 py::cast<std::string>(py::module_::import("os").attr("fspath")(path)));
           }),
           py::arg("path"))
      .def_property_readonly("environment", &Mapping::environment,
                             "env.id of the run, such as 'Pendulum-v1'.")
      .def("_observe", &Mapping::Observe, py::arg("arrays"), py::arg("first"))
      .def("action", &Mapping::Action, py::arg("action"),
           "Converts a policy's action (A,) in [-1, 1] to the action for env.step.");
}

}  // namespace shoal::python
