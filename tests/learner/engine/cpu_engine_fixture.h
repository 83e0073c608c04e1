// SPDX-License-Identifier: Apache-2.0
// A CPU engine with a small batch, and arrays and numbers of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/nn/host_memory.h"
#include "learner/engine/cpu_engine.h"
#include "tests/common/nn/gradient_check.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {

class CpuEngineTest : public testing::Test {
 public:
  static constexpr int kBatch = 6, kActions = 2;
  static constexpr double kTolerance = 1e-6;

 protected:
  // (b, columns) random numbers.
  Array Filled(int columns, uint64_t key) {
    const Array array = engine_.NewArray(columns);
    std::ranges::copy(nn::RandomValues(size_t(array.size()), key), nn::HostValues(array).begin());
    return array;
  }
  // A destination of results.
  Array Poisoned(int columns) {
    const Array array = engine_.NewArray(columns);
    std::ranges::fill(nn::HostValues(array), NAN);
    return array;
  }
  Number Holding(double value) {
    const Number number = engine_.NewNumber();
    nn::HostValues(number)[0] = value;
    return number;
  }
  SquashedSample NewSample() { return {Poisoned(kActions), Poisoned(kActions), Poisoned(1)}; }
  static nn::reference::Values Of(Array array) { return nn::ToDoubles(nn::HostValues(array)); }

  nn::Replica alone_;
  CpuEngine engine_{nn::Precision::kF32, kBatch, &alone_};
  const RandomBatch data_{SmallSpec(), kBatch, 3};
  Transitions batch_ = engine_.Take(data_.View());
  // A parameter and its optimiser, which complete what losses leave.
  nn::ParameterSet set_{{{"w", {3}}}, nn::ParameterSet::Use::kTraining};
  nn::Adam adam_{{&set_}, {.rate = 0.1}, engine_.modules()};
};

}  // namespace shoal::learner
