#include "common/nn/network_parameters.h"

#include "common/base/error.h"

namespace shoal::nn {
namespace {

constexpr int kKernel = 3;

void AddNorm(const std::string& name, int64_t size, std::vector<ParameterShape>* shapes) {
  shapes->push_back({name + ".norm.weight", {size}});
  shapes->push_back({name + ".norm.bias", {size}});
}

void AddLinear(const std::string& name, int64_t inputs, int64_t outputs,
               std::vector<ParameterShape>* shapes) {
  shapes->push_back({name + ".weight", {outputs, inputs}});
  shapes->push_back({name + ".bias", {outputs}});
}

void AddTrunk(const std::string& head, const NetworkConfig& network, const ObservationSpec& spec,
              std::vector<ParameterShape>* shapes) {
  if (!spec.HasPixels()) return;
  const MapSize map = ConvSizes(network, spec).back();
  const int64_t inputs = int64_t(network.filters.back()) * map.height * map.width;
  AddLinear(head + ".trunk", inputs, network.features, shapes);
  AddNorm(head + ".trunk", network.features, shapes);
}

void AddMlp(const std::string& name, const NetworkConfig& network, int64_t inputs, int64_t outputs,
            std::vector<ParameterShape>* shapes) {
  for (size_t i = 0; i < network.hidden.size(); ++i) {
    const std::string layer = name + ".layer" + std::to_string(i);
    AddLinear(layer, inputs, network.hidden[i], shapes);
    if (network.layer_norm) AddNorm(layer, network.hidden[i], shapes);
    inputs = network.hidden[i];
  }
  AddLinear(name + ".output", inputs, outputs, shapes);
}

}  // namespace

MapSize PooledSize(const NetworkConfig& network, const ObservationSpec& spec) {
  return {spec.height / network.pool, spec.width / network.pool};
}

std::vector<MapSize> ConvSizes(const NetworkConfig& network, const ObservationSpec& spec) {
  std::vector<MapSize> sizes;
  MapSize size = PooledSize(network, spec);
  for (size_t i = 0; i < network.filters.size(); ++i) {
    if (size.height < kKernel || size.width < kKernel) {
      throw UsageError(
          "network: convolution {} gets a {}x{} map from {}x{} images, expected at least {}x{}", i,
          size.height, size.width, spec.height, spec.width, kKernel, kKernel);
    }
    size.height = (size.height - kKernel) / network.strides[i] + 1;
    size.width = (size.width - kKernel) / network.strides[i] + 1;
    sizes.push_back(size);
  }
  return sizes;
}

int ObservationColumns(const NetworkConfig& network, const ObservationSpec& spec) {
  return (spec.HasPixels() ? network.features : 0) + spec.VectorSize();
}

std::vector<ParameterShape> EncoderParameters(const NetworkConfig& network,
                                              const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes;
  if (!spec.HasPixels()) return shapes;
  int64_t channels = int64_t(spec.stack) * spec.channels;
  for (size_t i = 0; i < network.filters.size(); ++i) {
    const std::string name = "encoder.conv" + std::to_string(i);
    shapes.push_back({name + ".weight", {network.filters[i], channels, kKernel, kKernel}});
    shapes.push_back({name + ".bias", {network.filters[i]}});
    channels = network.filters[i];
  }
  return shapes;
}

std::vector<ParameterShape> ActorParameters(const NetworkConfig& network,
                                            const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes;
  AddTrunk("actor", network, spec, &shapes);
  AddMlp("actor.mlp", network, ObservationColumns(network, spec), 2 * spec.action_size, &shapes);
  return shapes;
}

std::vector<ParameterShape> CriticParameters(const NetworkConfig& network,
                                             const ObservationSpec& spec, const std::string& head) {
  std::vector<ParameterShape> shapes;
  AddTrunk(head, network, spec, &shapes);
  const int inputs = ObservationColumns(network, spec) + spec.action_size;
  AddMlp(head + ".q1", network, inputs, 1, &shapes);
  AddMlp(head + ".q2", network, inputs, 1, &shapes);
  return shapes;
}

}  // namespace shoal::nn
