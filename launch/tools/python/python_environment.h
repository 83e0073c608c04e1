// SPDX-License-Identifier: Apache-2.0
// An environment with Gymnasium's interface, called from C++. Implements RawEnvironment
// (actor/hosted/raw_environment.h).
//
// Threads: constructed and called on one thread. Each call acquires Python's global lock (GIL);
// between calls the thread does not hold the GIL.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/hosted/raw_environment.h"
#include "common/tasks/environment_description.h"
#include "launch/tools/python/call_watch.h"
#include "launch/tools/python/space_array.h"

namespace shoal::python {

// Python function that makes environments, shoal_rl.hosting.open_environment, and the exception
// that it raises with a one-line message.
struct EnvironmentOpener {
  pybind11::object open, refused;
};

// An opened environment: shoal_rl.hosting.Opened.
struct OpenedEnvironment {
  pybind11::object opened;
  tasks::EnvironmentDescription description;  // without the facts that are found only by steps
};

// The environment to open: members of config.env.
struct EnvironmentOrder {
  std::string id, kwargs, folder, task;
  bool picture = false;  // pictures will be rendered (render_mode="rgb_array")
};
// Opens the environment. The caller holds the GIL. Throws Error (kUsage) if the environment does
// not exist, if Shoal cannot use the environment for training, or if the environment raised an
// exception, whose traceback is written to stderr.
OpenedEnvironment Open(const EnvironmentOpener& opener, const EnvironmentOrder& order);

// Records in the description whether Shoal can compute the environment's rewards for other goals
// (shoal_rl.goals). The caller holds the GIL. Throws the errors of Open.
void FindGoal(const EnvironmentOpener& opener, OpenedEnvironment* opened);

class __attribute__((visibility("hidden"))) PythonEnvironment final
    : public hosted::RawEnvironment {
 public:
  // The caller holds the GIL. Borrows the watch.
  PythonEnvironment(OpenedEnvironment opened, CallWatch& watch);
  ~PythonEnvironment() override;

  void Reset(uint32_t seed) override;
  hosted::RawStep Step(std::span<const double> action) override;
  std::span<const void* const> observation() const override { return arrays_; }
  double binding_seconds() const override { return binding_seconds_; }
  hosted::RawPicture Render() override;

 private:
  struct Leaf {
    std::vector<pybind11::object> keys;  // keys that lead through nested dicts to the array
    SpaceArray array;
  };

  pybind11::array ActionOf(std::span<const double> action);
  // Keeps the arrays of an observation alive and stores their addresses.
  void Take(const char* call, const pybind11::handle& observation);

  const tasks::EnvironmentDescription description_;
  CallWatch& watch_;
  pybind11::object environment_, reset_, step_;
  std::vector<pybind11::ssize_t> action_shape_;
  std::vector<Leaf> leaves_;
  std::vector<pybind11::array> held_;
  std::vector<const void*> arrays_;
  double binding_seconds_ = 0;
};

}  // namespace shoal::python
