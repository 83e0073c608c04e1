// SPDX-License-Identifier: Apache-2.0
// shoal_rl._native: what the Python package shoal-rl has of C++.
//
// Threads: every call holds Python's lock, so that there is one at a time in a process;
// environments step side by side in processes of their own (shoal_rl.make_vec). Errors:
// shoal::Error is shoal_rl.Error, its message one line.
#include <exception>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "launch/python/environment_binding.h"
#include "launch/python/policy_binding.h"

namespace py = pybind11;

PYBIND11_MODULE(_native, module) {
  // Lives as long as the process: translators have no argument to reach it by.
  static py::object error =  // NOLINT: set once, when the module is loaded
      py::exception<shoal::Error>(module, "Error");
  error.attr("__module__") = "shoal_rl";
  error.attr("__doc__") = "What was wrong and what was expected, in one line.";
  error.inc_ref();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const shoal::Error& e) {
      PyErr_SetString(error.ptr(), shoal::OneLine(e.what()).c_str());
    }
  });
  module.attr("__version__") = shoal::BuildVersion();
  shoal::python::BindPolicy(module);
  shoal::python::BindEnvironment(module);
}
