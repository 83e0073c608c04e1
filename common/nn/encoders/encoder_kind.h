// SPDX-License-Identifier: Apache-2.0
// Kinds of encoder. An encoder is a network that maps pixels to a feature map. Each kind has its
// own file; the key `network.encoder` selects the kind.
//
// A new kind needs a file in this folder, a declaration below, a line in the list of
// encoder_kind.cpp, and an entry in the key's list of choices (common/config/config_keys.cpp).
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "common/config/config.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {

struct EncoderKind {
  std::string_view name;
  // Appends the encoder's layers to a plan whose input is a stack of K frames (C, H, W), as (K*C,
  // H, W). Parameters are named `prefix`.conv{i}.* for convolution i, or `prefix`.NAME with
  // torchvision's NAME.
  void (*add)(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
  // The default trunk of this encoder: the number of outputs, and whether the trunk is linear and
  // ReLU (true) or linear, LayerNorm and tanh (false).
  int features = 50;
  bool relu_trunk = false;
};

// Small encoder: average pooling and 3x3 convolutions, set by network.pool, network.filters and
// network.strides.
void AddCompact(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// The encoder of DrQ, Kostrikov et al. 2020, arXiv:2004.13649, for 84x84 pixels.
void AddDrq(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// The convolutions of MR.Q, Fujimoto et al. 2025, arXiv:2501.16142, with ReLU.
void AddMrq(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// The convolutions of DQN, Mnih et al. 2015, doi:10.1038/nature14236.
void AddNature(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// ResNet-18, He et al. 2016, arXiv:1512.03385: torchvision's resnet18 without its last layer.
void AddResnet18(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// AlexNet, Krizhevsky 2014, arXiv:1404.5997: torchvision's alexnet without its classifier.
void AddAlexnet(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// Two convolutions on images of half the size, then a spatial softmax
// (common/nn/spatial_softmax.h).
void AddSpatialSoftmax(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);

std::span<const EncoderKind> EncoderKinds();
// If there is no kind of this name, throws Error (kUsage) that lists the existing kinds.
const EncoderKind& FindEncoderKind(std::string_view name);

// The convolutions of drq and mrq: 32 filters of 3x3 without padding for each stride, on images at
// their full size.
void AddConvolutions(const NetworkConfig& network, const std::string& prefix,
                     std::initializer_list<int> strides, NetworkPlan* plan);

// The initialisation of parameters that the configuration selects.
Initialisation InitialisationOf(const NetworkConfig& network);

}  // namespace shoal::nn
