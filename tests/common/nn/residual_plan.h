// SPDX-License-Identifier: Apache-2.0
// A small encoder with odd sizes whose layers have several readers.
#pragma once

#include <string>

#include "common/nn/network_plan.h"

namespace shoal::nn {

// `prefix` precedes each name. Pixels (2, 13, 11), a stem, a block with an identity skip, a block
// with a convolved skip, averages of 2x3.
inline NetworkPlan ResidualPlan(const std::string& prefix = "") {
  NetworkPlan plan({2, 13, 11});
  plan.AddPixels(1, "k", PixelRange::kUnit);
  const auto add = [&](const std::string& name, int filters, int kernel, int stride,
                       Activation activation, int source, int skip) {
    return plan.Add(NetworkPlan::Convolution{.name = prefix + name,
                                             .key = "k",
                                             .filters = filters,
                                             .kernel = kernel,
                                             .stride = stride,
                                             .padding = kernel / 2,
                                             .activation = activation,
                                             .bias = false,
                                             .batch_norm = prefix + name + ".bn",
                                             .source = source,
                                             .skip = skip});
  };
  constexpr Activation kRelu = Activation::kRelu, kNone = Activation::kNone;
  add("stem", 5, 3, 1, kRelu, kPreviousLayer, kNoLayer);
  const int in = plan.Add(
      NetworkPlan::MaxPool{.name = "pool", .key = "k", .kernel = 3, .stride = 2, .padding = 1});
  const int same = add("a.conv1", 5, 3, 1, kRelu, in, kNoLayer);
  const int middle = add("a.conv2", 5, 3, 1, kRelu, same, in);
  const int inner = add("b.conv1", 7, 3, 2, kRelu, middle, kNoLayer);
  const int around = add("b.around", 7, 1, 2, kNone, middle, kNoLayer);
  add("b.conv2", 7, 3, 1, kRelu, inner, around);
  plan.Add(NetworkPlan::AveragePool{.name = "average", .key = "k", .height = 2, .width = 3});
  return plan;
}

}  // namespace shoal::nn
