// SPDX-License-Identifier: Apache-2.0
// Context with which every layer of one network is built.
#pragma once

#include <memory>

#include "common/nn/op.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"

namespace shoal::nn {

// Layers follow one pattern. Construction builds the primitives for one batch size and looks the
// parameters up by name. Refresh() copies the parameters' current values and must follow every
// change of the parameters. Forward() reads the source, stores the values that the gradient needs
// and overwrites the output. Backward() refers to the latest Forward(). A layer is used by one
// thread at a time, under a ThreadScope of the same size as during construction.
struct LayerContext {
  ParameterSet* parameters;  // borrowed; outlives the layers
  Precision precision;
  int batch;
  bool training;  // false: Forward only
  std::shared_ptr<Scratchpad> scratchpad;
  // If true, gradients of weights are computed row-major, the layout of the parameter set, instead
  // of in the layout that the primitive prefers.
  bool plain_gradients = false;
};

// Which gradients a backward pass computes.
struct Gradients {
  bool parameters = true;
  bool source = true;
};

}  // namespace shoal::nn
