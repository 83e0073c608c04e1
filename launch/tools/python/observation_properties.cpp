// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/observation_properties.h"

namespace py = pybind11;

namespace shoal::python {

py::object PixelShape(const ObservationSpec& spec) {
  if (!spec.HasPixels()) return py::none();
  return py::make_tuple(spec.InputChannels(), spec.height, spec.width);
}

py::dict ObservedBlocks(const ObservationSpec& spec) {
  py::dict blocks;
  for (const BlockSpec& block : spec.blocks) {
    if (block.observed) blocks[py::str(block.name)] = block.size;
  }
  return blocks;
}

}  // namespace shoal::python
