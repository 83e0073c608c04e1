// SPDX-License-Identifier: Apache-2.0
// A readout predicts auxiliary labels as linear functions of a trunk's outputs. Its loss trains the
// trunk and the encoder below the trunk (Eq. 27 of docs/algorithm.md). A policy does not contain
// readouts.
//
//   y[b] = weight trunk[b] + bias          names READOUT.weight (L, F), READOUT.bias (L)
//
// Dimensions: B batch, F trunk outputs, L outputs.
#pragma once

#include <memory>
#include <string>

#include "common/nn/array.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"

namespace shoal::nn {

class ReadoutModule final : public Module {
 public:
  // `trunk`: trunk_features() of an ActorModule or CriticModule with Use::kTraining; borrowed. A
  // trunk has at most one readout.
  ReadoutModule(const std::string& name, int outputs, const Features& trunk,
                const ModuleContext& context);

  void Refresh() override { network_->Refresh(); }
  // Returns y (B, L) for the trunk's current outputs.
  Array Forward() { return network_->Forward(); }
  // Computes the gradients of the parameters and of the trunk's outputs from dL/dy (B, L). The next
  // Backward of the trunk's module uses the gradient of the outputs.
  void Backward(Array gradient) { network_->Backward(gradient); }

 private:
  const std::unique_ptr<ReadoutNetwork> network_;
};

}  // namespace shoal::nn
