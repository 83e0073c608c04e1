// SPDX-License-Identifier: Apache-2.0
// The compiled part of shoal_rl.make: one environment of a task, which writes into NumPy arrays.
// shoal_rl/environment.py wraps this environment as a Gymnasium environment.
#pragma once

#include <pybind11/pybind11.h>

namespace shoal::python {

void BindEnvironment(pybind11::module_& module);

}  // namespace shoal::python
