// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "common/base/error.h"
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {
namespace {

constexpr int kCompactKernel = 3;
constexpr int kDefaultPool = 2;

}  // namespace

void AddCompact(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  const int pool = network.pool == 0 ? kDefaultPool : network.pool;
  const std::vector<int> filters =
      network.filters.empty() ? std::vector{32, 32, 32} : network.filters;
  const std::vector<int> strides = network.strides.empty() ? std::vector{2, 1, 2} : network.strides;
  if (filters.size() != strides.size()) {
    throw UsageError("network.filters has {} entries and network.strides {}: expected as many",
                     filters.size(), strides.size());
  }
  const MapShape& images = plan->input();
  if (images.height % pool != 0 || images.width % pool != 0) {
    throw UsageError("network.pool = {}: expected a divisor of the image size {}x{}", pool,
                     images.height, images.width);
  }
  plan->AddPixels(pool, "network.pool");
  for (size_t i = 0; i < filters.size(); ++i) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + ".conv" + std::to_string(i),
                                       .key = "network.filters",
                                       .filters = filters[i],
                                       .kernel = kCompactKernel,
                                       .stride = strides[i],
                                       .initialisation = InitialisationOf(network)});
  }
}

}  // namespace shoal::nn
