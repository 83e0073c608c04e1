// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {
namespace {

constexpr int kPool = 2, kFilters = 32, kKernel = 3;
// Maps are flat at first. Without this factor all points would be near the middle.
constexpr double kSharpness = 10;

}  // namespace

void AddSpatialSoftmax(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  const char* const key = "network.encoder";
  const MapShape& images = plan->input();
  if (images.height % kPool != 0 || images.width % kPool != 0) {
    throw UsageError("network.encoder = spatial_softmax: expected images of even sides, not {}x{}",
                     images.height, images.width);
  }
  plan->AddPixels(kPool, key);
  const auto add = [&](const char* name, int stride, Activation activation) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + name,
                                       .key = key,
                                       .filters = kFilters,
                                       .kernel = kKernel,
                                       .stride = stride,
                                       .activation = activation,
                                       .initialisation = InitialisationOf(network)});
  };
  add(".conv0", 2, Activation::kRelu);
  add(".conv1", 1, Activation::kNone);
  plan->Add(NetworkPlan::SpatialSoftmax{.name = "points", .key = key, .sharpness = kSharpness});
}

}  // namespace shoal::nn
