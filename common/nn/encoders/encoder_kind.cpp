// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoders/encoder_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/base/error.h"

namespace shoal::nn {
namespace {

constexpr EncoderKind kEncoderKinds[] = {
    {.name = "compact", .add = AddCompact},
    {.name = "drq", .add = AddDrq},
    {.name = "mrq", .add = AddMrq},
    {.name = "nature", .add = AddNature, .features = 512, .relu_trunk = true},
    {.name = "resnet18", .add = AddResnet18},
    {.name = "alexnet", .add = AddAlexnet},
    {.name = "spatial_softmax", .add = AddSpatialSoftmax},
};

}  // namespace

std::span<const EncoderKind> EncoderKinds() { return kEncoderKinds; }

const EncoderKind& FindEncoderKind(std::string_view name) {
  std::vector<std::string_view> names;
  for (const EncoderKind& kind : kEncoderKinds) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  throw UsageError("network.encoder = {}: expected {}", name, fmt::join(names, " | "));
}

void AddConvolutions(const NetworkConfig& network, const std::string& prefix,
                     std::initializer_list<int> strides, NetworkPlan* plan) {
  plan->AddPixels(/*pool=*/1, "network.encoder");
  int i = 0;
  for (const int stride : strides) {
    plan->Add(NetworkPlan::Convolution{.name = prefix + ".conv" + std::to_string(i++),
                                       .key = "network.encoder",
                                       .filters = 32,
                                       .kernel = 3,
                                       .stride = stride,
                                       .initialisation = InitialisationOf(network)});
  }
}

Initialisation InitialisationOf(const NetworkConfig& network) {
  return network.initialisation == "pytorch" ? Initialisation::kPyTorch
                                             : Initialisation::kOrthogonal;
}

}  // namespace shoal::nn
