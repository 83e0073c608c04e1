// Names and shapes of every parameter of the networks: the one place that knows them. Checkpoints,
// weights on the wire and layers use these names.
//
// Dimensions: C input channels (K*C of the spec), N_i filters, h w size of the last feature map,
//   F trunk features, V vector size, A actions, H_i hidden units.
//
//   encoder.conv{i}.{weight (N_i, N_{i-1}, 3, 3), bias (N_i)}           only with pixels
//   HEAD.trunk.{weight (F, N*h*w), bias (F), norm.weight (F), norm.bias (F)}   only with pixels
//   MLP.layer{i}.{weight (H_i, H_{i-1}), bias (H_i), norm.weight (H_i), norm.bias (H_i)}
//   MLP.output.{weight (outputs, H), bias (outputs)}
//
// HEAD: actor, critic, target. MLP: actor.mlp (outputs 2A: mean, raw log deviation), HEAD.q1 and
// HEAD.q2 (outputs 1). norm of an MLP's layer only with network.layer_norm.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

struct ParameterShape {
  std::string name;
  std::vector<int64_t> shape;
};

// Height and width of the network's input after pooling, and after convolution `layer` (no
// padding).
struct MapSize {
  int height = 0, width = 0;
};
MapSize PooledSize(const NetworkConfig& network, const ObservationSpec& spec);
// Throws Error (kUsage) where the image is too small for the convolutions.
std::vector<MapSize> ConvSizes(const NetworkConfig& network, const ObservationSpec& spec);

// Columns that an MLP sees of an observation: F (with pixels) + V.
int ObservationColumns(const NetworkConfig& network, const ObservationSpec& spec);

// Empty without pixels.
std::vector<ParameterShape> EncoderParameters(const NetworkConfig& network,
                                              const ObservationSpec& spec);
std::vector<ParameterShape> ActorParameters(const NetworkConfig& network,
                                            const ObservationSpec& spec);
// `head` is "critic" or "target".
std::vector<ParameterShape> CriticParameters(const NetworkConfig& network,
                                             const ObservationSpec& spec, const std::string& head);

}  // namespace shoal::nn
