#include "common/nn/policy_size.h"

#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/nn/network_parameters.h"

namespace shoal::nn {
namespace {

constexpr int64_t kHeaderBytesPerTensor = 256;  // name, type, shape and offsets in JSON

int64_t Bytes(const ParameterShape& parameter) {
  int64_t bytes = sizeof(float);
  for (const int64_t extent : parameter.shape) bytes *= extent;
  return bytes;
}

std::vector<ParameterShape> PolicyParameters(const NetworkConfig& network,
                                             const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes = EncoderParameters(network, spec);
  const std::vector<ParameterShape> actor = ActorParameters(network, spec);
  shapes.insert(shapes.end(), actor.begin(), actor.end());
  return shapes;
}

const char* KeyOf(const std::string& parameter) {
  if (parameter.starts_with("encoder.")) return "network.filters";
  return parameter.starts_with("actor.trunk.") ? "network.features" : "network.hidden";
}

}  // namespace

int64_t PolicyBytes(const NetworkConfig& network, const ObservationSpec& spec) {
  int64_t bytes = kHeaderBytesPerTensor;
  for (const ParameterShape& parameter : PolicyParameters(network, spec)) {
    bytes += Bytes(parameter) + kHeaderBytesPerTensor;
  }
  return bytes;
}

void CheckPolicySize(const NetworkConfig& network, const ObservationSpec& spec,
                     int64_t most_bytes) {
  const int64_t bytes = PolicyBytes(network, spec);
  if (bytes <= most_bytes) return;
  const ParameterShape* largest = nullptr;
  const std::vector<ParameterShape> parameters = PolicyParameters(network, spec);
  for (const ParameterShape& parameter : parameters) {
    if (largest == nullptr || Bytes(parameter) > Bytes(*largest)) largest = &parameter;
  }
  throw UsageError(
      "{}: the policy's parameters take {:.1f} MB ({} alone {:.1f} MB), expected at most {:.1f} "
      "MB, "
      "which one message holds",
      KeyOf(largest->name), double(bytes) / 1e6, largest->name, double(Bytes(*largest)) / 1e6,
      double(most_bytes) / 1e6);
}

}  // namespace shoal::nn
