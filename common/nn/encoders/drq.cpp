// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {

void AddDrq(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  AddConvolutions(network, prefix, {2, 1, 1, 1}, plan);
}

}  // namespace shoal::nn
