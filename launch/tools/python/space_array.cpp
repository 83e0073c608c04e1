// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/space_array.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "launch/tools/python/shape_text.h"

namespace py = pybind11;

namespace shoal::python {

SpaceArray::SpaceArray(std::string environment, tasks::ArraySpace space)
    : environment_(std::move(environment)),
      space_(std::move(space)),
      type_(std::string(tasks::NameOf(space_.type))),
      real_(space_.type == tasks::ElementType::kFloat32 ||
            space_.type == tasks::ElementType::kFloat64),
      contiguous_(py::module_::import("numpy").attr("ascontiguousarray")) {}

void SpaceArray::CheckShape(const char* call, const py::array& array) const {
  const std::span<const py::ssize_t> shape(array.shape(), static_cast<size_t>(array.ndim()));
  const bool one_number = shape.empty() && space_.size() == 1;
  if (one_number || std::ranges::equal(shape, space_.shape)) return;
  const std::vector<py::ssize_t> expected(space_.shape.begin(), space_.shape.end());
  throw RuntimeError("environment {}: '{}' of {} has the shape {}; expected {}, as its space says",
                     environment_, space_.name, call, ShapeText(shape), ShapeText(expected));
}

py::array SpaceArray::Take(const char* call, const py::handle& value) const {
  const py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw RuntimeError("environment {}: '{}' of {} is no array of numbers", environment_,
                       space_.name, call);
  }
  CheckShape(call, array);
  const char type = array.dtype().char_(), declared = type_.char_();
  const bool same = type == declared || (type == 'q' && declared == 'l');
  if (!same && !(real_ && (type == 'f' || type == 'd'))) {
    throw RuntimeError(
        "environment {}: '{}' of {} has elements of type {}; expected {}, as its space says",
        environment_, space_.name, call, py::cast<std::string>(py::str(array.dtype())),
        py::cast<std::string>(py::str(py::handle(type_))));
  }
  const bool native = array.dtype().byteorder() != '>';
  constexpr int kPlain = int{py::array::c_style} | int{py::detail::npy_api::NPY_ARRAY_ALIGNED_};
  if (same && native && (array.flags() & kPlain) == kPlain) return array;
  return contiguous_(array, type_);
}

py::array ActionArray(const tasks::ArraySpace& space, const std::vector<py::ssize_t>& shape,
                      std::span<const double> action) {
  if (space.type == tasks::ElementType::kFloat64) {
    py::array_t<double> array(shape);
    std::ranges::copy(action, array.mutable_data());
    return array;
  }
  py::array_t<float> array(shape);
  std::ranges::transform(action, array.mutable_data(),
                         [](double number) { return static_cast<float>(number); });
  return array;
}

}  // namespace shoal::python
