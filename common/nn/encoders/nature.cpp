// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {

void AddNature(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  plan->AddPixels(/*pool=*/1, "network.encoder", PixelRange::kUnit);
  constexpr struct {
    int filters, kernel, stride;
  } kLayers[] = {{32, 8, 4}, {64, 4, 2}, {64, 3, 1}};
  int i = 0;
  for (const auto& [filters, kernel, stride] : kLayers) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + ".conv" + std::to_string(i++),
                                       .key = "network.encoder",
                                       .filters = filters,
                                       .kernel = kernel,
                                       .stride = stride,
                                       .initialisation = InitialisationOf(network)});
  }
}

}  // namespace shoal::nn
