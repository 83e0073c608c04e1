// SPDX-License-Identifier: Apache-2.0
// What a policy of an environment of Python observes of it, and its actions in the environment's
// units: the base class of shoal_rl.Mapping.
#pragma once

#include <pybind11/pybind11.h>

namespace shoal::python {

void BindMapping(pybind11::module_& module);

}  // namespace shoal::python
