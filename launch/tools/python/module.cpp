// SPDX-License-Identifier: Apache-2.0 shoal_rl._native: the C++ part of the Python package
// shoal-rl.
//
// Threads: every call holds Python's lock (GIL), so a process runs one call at a time. Environments
// step in parallel in separate processes (shoal_rl.make_vec). A call must not run Python code while
// it holds a C++ lock, including the guard of a static local variable: Python code may pass the GIL
// to a thread that then waits for the C++ lock for ever.
//
// Errors: shoal::Error is shoal_rl.Error, its message one line.
#include <pybind11/numpy.h>

#include <exception>
#include <vector>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/one_line.h"
#include "launch/tools/python/environment_binding.h"
#include "launch/tools/python/mapping_binding.h"
#include "launch/tools/python/policy_binding.h"

namespace py = pybind11;

namespace {

// pybind11 keeps NumPy's functions in a static local variable. Its first use imports NumPy, which
// runs Python code under a C++ guard, so two threads with simultaneous first calls would deadlock.
// This use, while the module is imported, initialises the variable before any call.
void ImportNumpy() { py::array_t<float>(std::vector<py::ssize_t>{0}); }

}  // namespace

PYBIND11_MODULE(_native, module) {
  ImportNumpy();
  // Static, because exception translators have no argument through which they could reach the
  // object.
  static py::object error =  // NOLINT: set once, when the module is loaded
      py::exception<shoal::Error>(module, "Error");
  error.attr("__module__") = "shoal_rl";
  error.attr("__doc__") = "An error of Shoal: what is wrong and what was expected, in one line.";
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
  shoal::python::BindMapping(module);
  shoal::python::BindEnvironment(module);
}
