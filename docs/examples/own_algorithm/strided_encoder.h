// Three convolutions of 5x5 with stride 2: a small encoder without pooling. The worked example of
// docs/own_algorithm.md.
#pragma once

#include <string>

#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {

// From (K*C, H, W) pixels to 32 maps of an eighth of their height and width, rounded down.
void AddStrided(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);

}  // namespace shoal::nn
