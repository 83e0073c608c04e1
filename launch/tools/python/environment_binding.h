// SPDX-License-Identifier: Apache-2.0
// The compiled half of shoal_rl.make: one environment of a task that writes into NumPy arrays.
// shoal_rl/environment.py makes a Gymnasium environment of it.
#pragma once

#include <pybind11/pybind11.h>

namespace shoal::python {

void BindEnvironment(pybind11::module_& module);

}  // namespace shoal::python
