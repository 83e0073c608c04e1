// SPDX-License-Identifier: Apache-2.0
// Properties of the observation that policies and environments expose in Python.
#pragma once

#include <pybind11/pybind11.h>

#include "common/spec/observation_spec.h"

namespace shoal::python {

// (channels, height, width) of one observation; None without pixels.
pybind11::object PixelShape(const ObservationSpec& spec);

// Name -> size of each observed block.
pybind11::dict ObservedBlocks(const ObservationSpec& spec);

}  // namespace shoal::python
