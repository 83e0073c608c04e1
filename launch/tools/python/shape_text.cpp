// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/shape_text.h"

namespace shoal::python {

std::string ShapeText(std::span<const pybind11::ssize_t> shape, bool batch) {
  std::string text = batch ? "(N" : "(";
  for (const pybind11::ssize_t side : shape) {
    text += (text == "(" ? "" : ", ") + std::to_string(side);
  }
  return text + (shape.size() == 1 && !batch ? ",)" : ")");
}

}  // namespace shoal::python
