// SPDX-License-Identifier: Apache-2.0
// A readout: linear functions of a trunk's outputs, which tell something that the trunk and the
// encoder below it are trained to know (Eq. 27 of docs/algorithm.md). No part of a policy.
//
//   y[b] = weight trunk[b] + bias          names READOUT.weight (L, F), READOUT.bias (L)
//
// Dimensions: B batch, F trunk outputs, L outputs.
#pragma once

#include <memory>
#include <string>

#include "common/nn/array.h"
#include "common/nn/module.h"

namespace shoal::nn {

class Features;

class ReadoutModule final : public Module {
 public:
  // Reads the trunk of a module for training (trunk_features of ActorModule or CriticModule), which
  // it borrows. A trunk has at most one readout.
  ReadoutModule(const std::string& name, int outputs, const Features& trunk,
                const ModuleContext& context);
  ~ReadoutModule() override;

  void Refresh() override;
  // (B, L), for the trunk's outputs as they are.
  Array Forward();
  // From dL/dy (B, L): gradients of the parameters, and that of the trunk, which the next Backward
  // of the trunk's module takes up.
  void Backward(Array gradient);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
