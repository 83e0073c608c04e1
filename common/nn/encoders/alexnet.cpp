// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {

// Parameters have torchvision's names behind the prefix. `index` counts the modules of
// torchvision's `features`, including ReLUs and pools.
void AddAlexnet(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  constexpr const char* kKey = "network.encoder";
  plan->AddPixels(/*pool=*/1, kKey, PixelRange::kUnit);
  constexpr struct {
    int index, filters, kernel, stride, padding;
    bool pool;  // whether a pool follows
  } kLayers[] = {{0, 64, 11, 4, 2, true},
                 {3, 192, 5, 1, 2, true},
                 {6, 384, 3, 1, 1, false},
                 {8, 256, 3, 1, 1, false},
                 {10, 256, 3, 1, 1, true}};
  for (const auto& [index, filters, kernel, stride, padding, pool] : kLayers) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + ".features." + std::to_string(index),
                                       .key = kKey,
                                       .filters = filters,
                                       .kernel = kernel,
                                       .stride = stride,
                                       .padding = padding,
                                       .initialisation = InitialisationOf(network)});
    if (!pool) continue;
    plan->Add(NetworkPlan::MaxPool{
        .name = "features." + std::to_string(index + 2), .key = kKey, .kernel = 3, .stride = 2});
  }
  plan->Add(NetworkPlan::AveragePool{.name = "avgpool", .key = kKey, .height = 6, .width = 6});
}

}  // namespace shoal::nn
