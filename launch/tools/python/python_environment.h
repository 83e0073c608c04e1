// SPDX-License-Identifier: Apache-2.0
// An environment of Gymnasium's interface, called from C++: takes the place of a physics engine
// behind actor/hosted/hosted_environment.h.
//
// Threads: made and called on one thread, which does not hold Python's lock between the calls; each
// call takes it.
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

// The maker of environments: shoal_rl.hosting.open_environment, and its exception of one line.
struct EnvironmentOpener {
  pybind11::object open, refused;
};

// An environment that was opened: shoal_rl.hosting.Opened.
struct OpenedEnvironment {
  pybind11::object opened;
  tasks::EnvironmentDescription description;  // without what playing shows
};

// Opens config.env. Holds Python's lock. Throws Error (kUsage): no such environment, or one that
// Shoal cannot train; an exception of the environment's own, whose traceback goes to stderr.
struct EnvironmentOrder {
  std::string id, kwargs, folder, task;
  bool picture = false;  // it will be asked for pictures (render_mode="rgb_array")
};
OpenedEnvironment Open(const EnvironmentOpener& opener, const EnvironmentOrder& order);

// Notes in the description whether Shoal can compute the environment's rewards for other goals
// (shoal_rl.goals). Holds Python's lock. Throws Error as Open does.
void FindGoal(const EnvironmentOpener& opener, OpenedEnvironment* opened);

class __attribute__((visibility("hidden"))) PythonEnvironment final
    : public hosted::RawEnvironment {
 public:
  // Holds Python's lock. Borrows the watch.
  PythonEnvironment(OpenedEnvironment opened, CallWatch& watch);
  ~PythonEnvironment() override;

  void Reset(uint32_t seed) override;
  hosted::RawStep Step(std::span<const double> action) override;
  std::span<const void* const> observation() const override { return arrays_; }
  double binding_seconds() const override { return binding_seconds_; }
  hosted::RawPicture Render() override;

 private:
  struct Leaf {
    std::vector<pybind11::object> keys;  // into nested dicts
    SpaceArray array;
  };

  pybind11::array ActionOf(std::span<const double> action);
  // Keeps the arrays of an observation alive and notes where they lie.
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
