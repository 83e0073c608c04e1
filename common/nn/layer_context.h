// SPDX-License-Identifier: Apache-2.0
// Context that every layer of one network is built with.
#pragma once

#include <memory>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"

namespace shoal::nn {

// Layers follow one pattern. Construction builds the primitives for one batch size and looks the
// parameters up by name. Refresh() takes over the parameters' present values and must follow every
// change of them. Forward() reads the source, keeps what its gradient needs and overwrites the
// output. Backward() refers to the latest Forward(). A layer is used by one thread at a time, under
// a ThreadScope of the size it was built in.
struct LayerContext {
  ParameterSet* parameters;  // borrowed; outlives the layers
  Precision precision;
  int batch;
  bool training;  // false: Forward only
  std::shared_ptr<Scratchpad> scratchpad;
  // Gradients of weights are computed row-major, as the set keeps them, in place of the layout that
  // the primitive prefers: see Linear.
  bool plain_gradients = false;
};

// Which gradients a backward pass computes.
struct Gradients {
  bool parameters = true;
  bool source = true;
};

}  // namespace shoal::nn
