// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoder_weights.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {
namespace {

constexpr std::string_view kPrefix = "encoder.";

bool IsTorchvisionsOwn(std::string_view name) {
  return name.starts_with("fc.") || name.starts_with("classifier.") ||
         name.ends_with(".num_batches_tracked");
}

// Refuses tensors that the network does not have: a deeper network of the same kind has all of its
// tensors and more.
void RefuseOthers(const TensorMap& tensors, const ParameterSet& set, bool prefixed,
                  const NetworkConfig& network) {
  for (const auto& [name, tensor] : tensors) {
    const bool others = prefixed ? !name.starts_with(kPrefix) : IsTorchvisionsOwn(name);
    if (others || set.Has(name)) continue;
    throw UsageError("{}: tensor {} is none of network.encoder = {}", network.encoder_weights, name,
                     network.encoder);
  }
}

void RefuseNonFinite(const TensorMap& tensors, const std::string& source) {
  for (const auto& [name, tensor] : tensors) {
    for (size_t i = 0; i < tensor.data.size(); i += sizeof(float)) {
      float value;
      std::memcpy(&value, tensor.data.data() + i, sizeof(value));
      if (std::isfinite(value)) continue;
      throw UsageError("{}: tensor {} holds {}, expected finite numbers", source, name, value);
    }
  }
}

TensorMap Read(const NetworkConfig& network, const ObservationSpec& spec) {
  const std::string& source = network.encoder_weights;
  const TensorMap tensors = ReadSafetensors(ReadFile(source), source);
  const bool prefixed = std::ranges::any_of(
      tensors, [](const auto& tensor) { return tensor.first.starts_with(kPrefix); });
  std::vector<ParameterSpec> specs = PlanEncoder(network, spec).Parameters();
  if (!prefixed) {
    for (ParameterSpec& parameter : specs) parameter.name.erase(0, kPrefix.size());
  }
  ParameterSet set(specs, ParameterSet::Use::kInference);
  set.Import(tensors, "", source, set.values());
  RefuseOthers(tensors, set, prefixed, network);
  TensorMap weights;
  set.Export(set.values(), prefixed ? "" : std::string(kPrefix), &weights);
  RefuseNonFinite(weights, source);
  return weights;
}

}  // namespace

TensorMap ReadEncoderWeights(const NetworkConfig& network, const ObservationSpec& spec) {
  if (network.encoder_weights.empty()) return {};
  if (!spec.HasPixels()) {
    throw UsageError("network.encoder_weights = {}: there is no encoder without pixels",
                     network.encoder_weights);
  }
  try {
    return Read(network, spec);
  } catch (const Error& error) {
    throw UsageError("network.encoder_weights: {}", error.what());
  }
}

}  // namespace shoal::nn
