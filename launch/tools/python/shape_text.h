// SPDX-License-Identifier: Apache-2.0
// Shapes of arrays in Python's notation, for messages.
#pragma once

#include <pybind11/pybind11.h>

#include <span>
#include <string>

namespace shoal::python {

// "(3,)"; with `batch`, N is the first dimension: "(N, 3)".
std::string ShapeText(std::span<const pybind11::ssize_t> shape, bool batch = false);

}  // namespace shoal::python
