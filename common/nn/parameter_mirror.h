// SPDX-License-Identifier: Apache-2.0
// Copies of parameters and of an optimiser's moments in the memory of an engine that does not
// compute in host memory. The set or the optimiser keeps track of which copy is the newest one, and
// copies when the older one is used.
//
// Arrays of the host have the layout of the set (parameter_set.h). A mirror may use another one.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace shoal::nn {

// Mirror of the values of a ParameterSet, which owns it. The engine attaches the mirror. Fetch and
// Send return when the copy is complete.
class ParameterMirror {
 public:
  virtual ~ParameterMirror() = default;

  // Begins a copy of the mirror's values as the work leaves them that the engine has submitted so
  // far. Later work does not change the copy. The returned function waits until the copy is
  // complete and writes it to an array of the host.
  virtual std::function<void(float* values)> BeginFetch() = 0;
  // Copies the mirror's values to `values`, the array of the host.
  void Fetch(float* values) { BeginFetch()(values); }
  // Copies `values`, the array of the host, to the mirror.
  virtual void Send(const float* values) = 0;
};

// Mirror of the state of an Adam, which owns it.
class AdamMirror {
 public:
  // Moments of one parameter set on the host, each of the set's trained size.
  struct Moments {
    float *m, *v;
  };

  virtual ~AdamMirror() = default;

  // Copies the moments of all sets to the host and returns the number of steps.
  virtual uint64_t Fetch(std::span<const Moments> sets) = 0;
  virtual void Send(std::span<const Moments> sets, uint64_t steps) = 0;
};

}  // namespace shoal::nn
