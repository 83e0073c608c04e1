// SPDX-License-Identifier: Apache-2.0
#include "common/nn/plan_text.h"

#include <fmt/core.h>

namespace shoal::nn {
namespace {

const char* KindName(LayerPlan::Kind kind) {
  switch (kind) {
    case LayerPlan::Kind::kPixels:
      return "pixels";
    case LayerPlan::Kind::kConvolution:
      return "convolution";
    case LayerPlan::Kind::kMaxPool:
      return "max pool";
    case LayerPlan::Kind::kAveragePool:
      return "average pool";
    case LayerPlan::Kind::kSpatialSoftmax:
      return "spatial softmax";
    case LayerPlan::Kind::kLinear:
      return "linear";
    case LayerPlan::Kind::kLayerNorm:
      return "layer norm";
  }
  return "";
}

const char* ActivationName(Activation activation) {
  switch (activation) {
    case Activation::kNone:
      return "";
    case Activation::kRelu:
      return ", relu";
    case Activation::kTanh:
      return ", tanh";
    case Activation::kElu:
      return ", elu";
  }
  return "";
}

std::string MapShapeText(const MapShape& shape) {
  return fmt::format("{}x{}x{}", shape.channels, shape.height, shape.width);
}

bool HasWindow(LayerPlan::Kind kind) {
  return kind == LayerPlan::Kind::kPixels || kind == LayerPlan::Kind::kConvolution ||
         kind == LayerPlan::Kind::kMaxPool;
}

}  // namespace

std::string PlanLine(const LayerPlan& layer) {
  std::string line = fmt::format("{}: {}", layer.name, KindName(layer.kind));
  if (layer.source != kNoLayer) line += fmt::format(" of layer {}", layer.source);
  line += fmt::format(", {} to {}", MapShapeText(layer.input), MapShapeText(layer.output));
  if (HasWindow(layer.kind)) {
    line += fmt::format(", kernel {}, stride {}, padding {}", layer.kernel, layer.stride,
                        layer.padding);
  }
  if (layer.kind == LayerPlan::Kind::kSpatialSoftmax) {
    line += fmt::format(", sharpness {}", layer.sharpness);
  }
  if (layer.kind == LayerPlan::Kind::kPixels) {
    line += layer.range == PixelRange::kUnit ? ", in [0, 1]" : ", in [-0.5, 0.5]";
  } else if (layer.bias && !layer.Parameters().empty()) {
    line += ", bias";
  }
  if (layer.layer_norm) line += ", layer norm";
  if (!layer.batch_norm.empty()) line += ", batch norm " + layer.batch_norm;
  if (layer.skip != kNoLayer) line += fmt::format(", plus layer {}", layer.skip);
  return line + ActivationName(layer.activation);
}

std::vector<std::string> PlanLines(const NetworkPlan& encoder, const ActorPlan& actor) {
  std::vector<std::string> lines;
  const auto add = [&](const NetworkPlan& plan) {
    for (const LayerPlan& layer : plan.layers()) lines.push_back(PlanLine(layer));
  };
  add(encoder);
  add(actor.trunk);
  lines.push_back(fmt::format("input of the MLP: {} features, vector of {}", actor.trunk_columns(),
                              actor.vector_columns));
  for (const NetworkPlan& mlp : actor.mlps) add(mlp);
  lines.push_back(fmt::format("action of {}: {}", actor.action_size, ToString(actor.output)));
  return lines;
}

const char* ToString(ActorOutput output) {
  switch (output) {
    case ActorOutput::kGaussian:
      return "gaussian";
    case ActorOutput::kDeterministic:
      return "deterministic";
    case ActorOutput::kUnsquashed:
      return "unsquashed";
  }
  return "";
}

}  // namespace shoal::nn
