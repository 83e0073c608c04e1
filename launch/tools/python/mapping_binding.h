// SPDX-License-Identifier: Apache-2.0
// The base class of shoal_rl.Mapping, which connects a Python environment with the policy that was
// trained on it.
#pragma once

#include <pybind11/pybind11.h>

namespace shoal::python {

void BindMapping(pybind11::module_& module);

}  // namespace shoal::python
