// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy that stand for one array of an environment's description: checked, and brought
// into the layout that the description says.
#pragma once

#include <pybind11/numpy.h>

#include <span>
#include <string>
#include <vector>

#include "common/tasks/environment_description.h"

namespace shoal::python {

// pybind11's types are hidden by its attribute.
class __attribute__((visibility("hidden"))) SpaceArray {
 public:
  // Holds Python's lock, as every call does. `environment` names it in messages.
  SpaceArray(std::string environment, tasks::ArraySpace space);

  const tasks::ArraySpace& space() const { return space_; }
  // `value` itself if it fits, else a copy: contiguous in C order, of the description's element
  // type. float32 and float64 stand for each other: many environments declare one and return the
  // other. Throws Error (kRuntime) naming `call` on another shape or element type.
  pybind11::array Take(const char* call, const pybind11::handle& value) const;

 private:
  void CheckShape(const char* call, const pybind11::array& array) const;

  const std::string environment_;
  const tasks::ArraySpace space_;
  const pybind11::dtype type_;
  const bool real_;                    // float32 or float64
  const pybind11::object contiguous_;  // numpy.ascontiguousarray
};

// The argument of env.step: `action`, in the environment's units, as an array of the action space's
// element type (float32 or float64) and of `shape`. Holds Python's lock.
pybind11::array ActionArray(const tasks::ArraySpace& space,
                            const std::vector<pybind11::ssize_t>& shape,
                            std::span<const double> action);

}  // namespace shoal::python
