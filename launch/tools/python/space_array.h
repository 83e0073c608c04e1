// SPDX-License-Identifier: Apache-2.0
// Checks a NumPy array against one array of an environment's description, and converts it to the
// layout of the description.
#pragma once

#include <pybind11/numpy.h>

#include <span>
#include <string>
#include <vector>

#include "common/tasks/environment_description.h"

namespace shoal::python {

// The attribute hides the class, because pybind11's types are hidden.
class __attribute__((visibility("hidden"))) SpaceArray {
 public:
  // The caller holds the GIL in all calls. `environment`: name of the environment in messages.
  SpaceArray(std::string environment, tasks::ArraySpace space);

  const tasks::ArraySpace& space() const { return space_; }
  // Returns `value` as an array that is contiguous in C order and has the element type of the
  // description. If `value` is not such an array, the result is a copy. float32 is accepted for
  // float64 and the reverse, because many environments declare one type and return the other.
  // Throws Error (kRuntime) naming `call` on another shape or element type.
  pybind11::array Take(const char* call, const pybind11::handle& value) const;

 private:
  void CheckShape(const char* call, const pybind11::array& array) const;

  const std::string environment_;
  const tasks::ArraySpace space_;
  const pybind11::dtype type_;
  const bool real_;                    // the element type is float32 or float64
  const pybind11::object contiguous_;  // numpy.ascontiguousarray
};

// The argument of env.step: `action`, in the environment's units, as an array of the action space's
// element type (float32 or float64) and of `shape`. The caller holds the GIL.
pybind11::array ActionArray(const tasks::ArraySpace& space,
                            const std::vector<pybind11::ssize_t>& shape,
                            std::span<const double> action);

}  // namespace shoal::python
