// SPDX-License-Identifier: Apache-2.0
// Encoders: networks from pixels to a feature map, one kind a file. `network.encoder` names it.
//
// A further kind is a file beside these, a declaration, a line in the list of encoder_kind.cpp, and
// its word in the key's choices (common/config/config_keys.cpp).
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
  // Appends the encoder's layers to a plan whose input are stacks of frames, (K*C, H, W). Names of
  // parameters begin with `prefix`.: `prefix`.conv{i}.* of convolution i, or `prefix`. and
  // torchvision's name.
  void (*add)(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
  // The trunk that belongs to it where the configuration does not say another: its outputs, and
  // whether they are linear and ReLU instead of linear, LayerNorm and tanh.
  int features = 50;
  bool relu_trunk = false;
};

// Average pooling and 3x3 convolutions of network.pool, network.filters and network.strides; small.
void AddCompact(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// Kostrikov et al. 2020, arXiv:2004.13649; of 84x84 pixels.
void AddDrq(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// The convolutions of MR.Q, Fujimoto et al. 2025, arXiv:2501.16142, with ReLU.
void AddMrq(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// Mnih et al. 2015, doi:10.1038/nature14236.
void AddNature(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// He et al. 2016, arXiv:1512.03385, as torchvision's resnet18 without its last layer.
void AddResnet18(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// Krizhevsky 2014, arXiv:1404.5997, as torchvision's alexnet without its classifier.
void AddAlexnet(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);
// Two convolutions of images of half the size, then points: common/nn/spatial_softmax.h.
void AddSpatialSoftmax(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan);

std::span<const EncoderKind> EncoderKinds();
// Throws Error (kUsage) naming an unknown kind and those there are.
const EncoderKind& FindEncoderKind(std::string_view name);

// The convolutions of drq and mrq: 32 filters of 3x3 without padding for each stride, on images at
// their full size.
void AddConvolutions(const NetworkConfig& network, const std::string& prefix,
                     std::initializer_list<int> strides, NetworkPlan* plan);

// How the configuration lets parameters start.
Initialisation InitialisationOf(const NetworkConfig& network);

}  // namespace shoal::nn
