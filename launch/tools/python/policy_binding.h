// SPDX-License-Identifier: Apache-2.0
// shoal_rl.Policy: a checkpoint's policy that acts on NumPy arrays.
#pragma once

#include <pybind11/pybind11.h>

namespace shoal::python {

void BindPolicy(pybind11::module_& module);

}  // namespace shoal::python
