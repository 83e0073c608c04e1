// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/python_environment.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "common/wire/scoped_seconds.h"

namespace py = pybind11;

namespace shoal::python {
namespace {

// Writes the traceback of a Python exception to the log and throws Error with its message.
[[noreturn]] void Fail(ErrorKind kind, const std::string& id, const std::string& call,
                       const py::error_already_set& error) {
  py::module_::import("traceback")
      .attr("print_exception")(error.type(), error.value(),
                               error.trace() ? error.trace() : py::object(py::none()));
  const auto name = py::cast<std::string>(error.type().attr("__name__"));
  const auto message = py::cast<std::string>(py::str(error.value()));
  throw Error(kind, fmt::format("environment {}: {} raised {}{}{}", id, call, name,
                                message.empty() ? "" : ": ", OneLine(message)));
}

// Throws as Fail does, but a refusal of shoal_rl.hosting becomes one line without a traceback.
[[noreturn]] void Refuse(const EnvironmentOpener& opener, const std::string& id,
                         const std::string& call, const py::error_already_set& error) {
  if (!error.matches(opener.refused)) Fail(ErrorKind::kUsage, id, call, error);
  throw UsageError("environment {}: {}", id,
                   OneLine(py::cast<std::string>(py::str(error.value()))));
}

bool TruthOf(const py::handle& value) {
  const int truth = PyObject_IsTrue(value.ptr());
  if (truth < 0) throw py::error_already_set();
  return truth == 1;
}

// info["is_success"] or info["success"]; empty if it has neither.
std::optional<bool> SuccessIn(const py::handle& info) {
  if (!PyDict_Check(info.ptr())) return std::nullopt;
  for (const char* key : {"is_success", "success"}) {
    if (PyObject* value = PyDict_GetItemString(info.ptr(), key)) return TruthOf(value);
  }
  return std::nullopt;
}

double NumberOf(const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return number;
}

}  // namespace

OpenedEnvironment Open(const EnvironmentOpener& opener, const EnvironmentOrder& order) {
  try {
    OpenedEnvironment opened{
        .opened = opener.open(order.id, order.kwargs, order.folder,
                              order.picture ? py::str("rgb_array") : py::str("")),
        .description = {}};
    auto described =
        ParseBoundedJson<nlohmann::json>(py::cast<std::string>(opened.opened.attr("description")));
    described["schema"] = tasks::kEnvironmentSchema;
    described["id"] = order.id;
    described["task"] = order.task;
    described["success"] = false;
    opened.description = tasks::EnvironmentFromJson(described);
    return opened;
  } catch (const py::error_already_set& error) {
    Refuse(opener, order.id, "making it", error);
  }
}

void FindGoal(const EnvironmentOpener& opener, OpenedEnvironment* opened) {
  tasks::EnvironmentDescription& description = opened->description;
  try {
    auto described = ToJson(description);
    described.update(ParseBoundedJson<nlohmann::json>(
        py::cast<std::string>(opened->opened.attr("find_goal")())));
    description = tasks::EnvironmentFromJson(described);
  } catch (const py::error_already_set& error) {
    Refuse(opener, description.id, "reset or compute_reward", error);
  }
}

PythonEnvironment::PythonEnvironment(OpenedEnvironment opened, CallWatch& watch)
    : description_(std::move(opened.description)),
      watch_(watch),
      environment_(opened.opened.attr("environment")),
      reset_(environment_.attr("reset")),
      step_(environment_.attr("step")),
      action_shape_(py::cast<std::vector<py::ssize_t>>(opened.opened.attr("action_shape"))) {
  const py::list paths = opened.opened.attr("paths");
  CHECK(py::len(paths) == description_.observation.size()) << py::len(paths);
  for (size_t i = 0; i < description_.observation.size(); ++i) {
    Leaf leaf{.keys = {}, .array = {description_.id, description_.observation[i]}};
    for (const py::handle& key : py::tuple(paths[i])) {
      leaf.keys.push_back(py::reinterpret_borrow<py::object>(key));
    }
    leaves_.push_back(std::move(leaf));
  }
  held_.resize(leaves_.size());
  arrays_.resize(leaves_.size());
}

PythonEnvironment::~PythonEnvironment() {
  const py::gil_scoped_acquire lock;
  try {
    if (py::hasattr(environment_, "close")) environment_.attr("close")();
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("close");  // the process is about to exit
  }
  for (py::object* object : {&environment_, &reset_, &step_}) *object = py::object();
  leaves_.clear();
  held_.clear();
}

void PythonEnvironment::Take(const char* call, const py::handle& observation) {
  for (size_t i = 0; i < leaves_.size(); ++i) {
    py::object value = py::reinterpret_borrow<py::object>(observation);
    for (const py::object& key : leaves_[i].keys) {
      if (!PyMapping_Check(value.ptr())) {
        throw RuntimeError("environment {}: {} returned no dict where its space is a Dict",
                           description_.id, call);
      }
      PyObject* inner = PyObject_GetItem(value.ptr(), key.ptr());
      if (inner == nullptr) {
        PyErr_Clear();
        throw RuntimeError("environment {}: the observation of {} has no '{}'", description_.id,
                           call, description_.observation[i].name);
      }
      value = py::reinterpret_steal<py::object>(inner);
    }
    held_[i] = leaves_[i].array.Take(call, value);
    arrays_[i] = held_[i].data();
  }
}

void PythonEnvironment::Reset(uint32_t seed) {
  const py::gil_scoped_acquire lock;
  const CallWatch::Call call(watch_, "reset");
  try {
    const py::object result = reset_(py::arg("seed") = seed);
    const ScopedSeconds timed(binding_seconds_);
    if (!py::isinstance<py::tuple>(result) || py::len(result) != 2) {
      throw RuntimeError(
          "environment {}: reset returned no pair of observation and info, as Gymnasium 1.x has it",
          description_.id);
    }
    Take("reset", py::tuple(result)[0]);
  } catch (const py::error_already_set& error) {
    Fail(ErrorKind::kRuntime, description_.id, "reset", error);
  }
}

py::array PythonEnvironment::ActionOf(std::span<const double> action) {
  const ScopedSeconds timed(binding_seconds_);
  return ActionArray(description_.action, action_shape_, action);
}

hosted::RawStep PythonEnvironment::Step(std::span<const double> action) {
  const py::gil_scoped_acquire lock;
  const CallWatch::Call call(watch_, "step");
  try {
    const py::object result = step_(ActionOf(action));
    const ScopedSeconds timed(binding_seconds_);
    if (!PyTuple_Check(result.ptr()) || PyTuple_GET_SIZE(result.ptr()) != 5) {
      throw RuntimeError(
          "environment {}: step returned no tuple of observation, reward, terminated, truncated "
          "and info, as Gymnasium 1.x has it",
          description_.id);
    }
    const auto part = [&](int i) { return py::handle(PyTuple_GET_ITEM(result.ptr(), i)); };
    Take("step", part(0));
    return {.reward = NumberOf(part(1)),
            .terminated = TruthOf(part(2)),
            .truncated = TruthOf(part(3)),
            .success = SuccessIn(part(4))};
  } catch (const py::error_already_set& error) {
    Fail(ErrorKind::kRuntime, description_.id, "step", error);
  }
}

hosted::RawPicture PythonEnvironment::Render() {
  const py::gil_scoped_acquire lock;
  const CallWatch::Call call(watch_, "render");
  try {
    const py::object drawn = environment_.attr("render")();
    const auto array = py::array_t<uint8_t, py::array::c_style>::ensure(drawn);
    const bool picture = array && array.ndim() == 3 && array.shape(2) == 3;
    if (!picture) {
      PyErr_Clear();
      throw RuntimeError(
          "environment {}: render returned no picture (H, W, 3) of uint8, which "
          "render_mode=\"rgb_array\" stands for",
          description_.id);
    }
    return {.height = int(array.shape(0)),
            .width = int(array.shape(1)),
            .pixels = std::vector<uint8_t>(array.data(), array.data() + array.size())};
  } catch (const py::error_already_set& error) {
    Fail(ErrorKind::kRuntime, description_.id, "render", error);
  }
}

}  // namespace shoal::python
