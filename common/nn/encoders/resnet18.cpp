// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoders/encoder_kind.h"

namespace shoal::nn {
namespace {

constexpr const char* kKey = "network.encoder";

// Parameters have torchvision's names behind the prefix.
class ResnetPlan {
 public:
  ResnetPlan(const NetworkConfig& network, std::string prefix, NetworkPlan* plan)
      : prefix_(std::move(prefix)),
        initialisation_(network.initialisation == "pytorch" ? Initialisation::kKaiming
                                                            : Initialisation::kOrthogonal),
        plan_(plan) {}

  // Returns the layer's index.
  struct Layer {
    std::string name, norm;
    int filters, kernel, stride;
    Activation activation = Activation::kRelu;
    int source = kPreviousLayer, skip = kNoLayer;
  };
  int Add(const Layer& layer) {
    return plan_->Add(NetworkPlan::Convolution{.name = prefix_ + "." + layer.name,
                                               .key = kKey,
                                               .filters = layer.filters,
                                               .kernel = layer.kernel,
                                               .stride = layer.stride,
                                               .padding = layer.kernel / 2,
                                               .activation = layer.activation,
                                               .initialisation = initialisation_,
                                               .bias = false,
                                               .batch_norm = prefix_ + "." + layer.norm,
                                               .source = layer.source,
                                               .skip = layer.skip});
  }

  // Adds two 3x3 convolutions and their bypass: the block's input `source`, or a 1x1 convolution of
  // it if the map's shape changes. Returns the index of the block's output.
  int AddBlock(const std::string& name, int filters, int stride, int source) {
    const bool same = stride == 1 && plan_->layers()[size_t(source)].output.channels == filters;
    const int inner =
        Add({name + ".conv1", name + ".bn1", filters, 3, stride, Activation::kRelu, source});
    const int skip = same ? source
                          : Add({name + ".downsample.0", name + ".downsample.1", filters, 1, stride,
                                 Activation::kNone, source});
    return Add({name + ".conv2", name + ".bn2", filters, 3, 1, Activation::kRelu, inner, skip});
  }

 private:
  const std::string prefix_;
  const Initialisation initialisation_;
  NetworkPlan* plan_;
};

}  // namespace

void AddResnet18(const NetworkConfig& network, const std::string& prefix, NetworkPlan* plan) {
  plan->AddPixels(/*pool=*/1, kKey, PixelRange::kUnit);
  ResnetPlan resnet(network, prefix, plan);
  resnet.Add({"conv1", "bn1", 64, 7, 2});
  int last = plan->Add(
      NetworkPlan::MaxPool{.name = "maxpool", .key = kKey, .kernel = 3, .stride = 2, .padding = 1});
  for (int group = 1; group <= 4; ++group) {
    const std::string name = "layer" + std::to_string(group);
    const int filters = 32 << group;
    last = resnet.AddBlock(name + ".0", filters, group == 1 ? 1 : 2, last);
    last = resnet.AddBlock(name + ".1", filters, 1, last);
  }
  plan->Add(NetworkPlan::AveragePool{.name = "avgpool", .key = kKey, .height = 1, .width = 1});
}

}  // namespace shoal::nn
