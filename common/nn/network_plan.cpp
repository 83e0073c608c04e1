#include "common/nn/network_plan.h"

#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::nn {
namespace {

// The usual gain in front of a ReLU's halved variance.
const double kConvolutionGain = std::sqrt(2.0);

// One side of a map after a window has passed over it.
int Windows(int side, int kernel, int stride, int padding) {
  return (side + 2 * padding - kernel) / stride + 1;
}

Start WeightStart(const LayerPlan& layer, int64_t inputs) {
  if (layer.initialisation == Initialisation::kPyTorch) {
    return {Start::Kind::kUniform, 1 / std::sqrt(double(inputs))};
  }
  return {Start::Kind::kOrthogonal, layer.gain};
}

Start BiasStart(const LayerPlan& layer, int64_t inputs) {
  if (layer.initialisation == Initialisation::kPyTorch) return WeightStart(layer, inputs);
  return {Start::Kind::kZeros};
}

}  // namespace

std::vector<ParameterSpec> LayerPlan::Parameters() const {
  if (kind == Kind::kPixels) return {};
  const int64_t outputs = output.channels;
  std::vector<int64_t> weight{outputs, input.channels};
  int64_t inputs = input.channels;  // of one output
  if (kind == Kind::kConvolution) {
    weight.insert(weight.end(), {kernel, kernel});
    inputs *= int64_t{kernel} * kernel;
  }
  std::vector<ParameterSpec> parameters{{name + ".weight", weight, WeightStart(*this, inputs)},
                                        {name + ".bias", {outputs}, BiasStart(*this, inputs)}};
  if (layer_norm) {
    parameters.push_back({name + ".norm.weight", {outputs}, {Start::Kind::kOnes}});
    parameters.push_back({name + ".norm.bias", {outputs}, {Start::Kind::kZeros}});
  }
  return parameters;
}

void NetworkPlan::AddPixels(int pool, const std::string& key) {
  CHECK(layers_.empty()) << "pixels are what a network begins with";
  LayerPlan layer{.kind = LayerPlan::Kind::kPixels,
                  .name = "pixels",
                  .key = key,
                  .input = input_,
                  .kernel = pool,
                  .stride = pool};
  layer.output = {input_.channels, input_.height / pool, input_.width / pool};
  layers_.push_back(std::move(layer));
}

void NetworkPlan::Add(const Convolution& convolution) {
  const auto& [name, key, filters, kernel, stride, padding, activation, initialisation] =
      convolution;
  const MapShape from = output();
  if (from.height + 2 * padding < kernel || from.width + 2 * padding < kernel) {
    throw UsageError("{}: a {}x{} map is smaller than the {}x{} kernel of {}", key, from.height,
                     from.width, kernel, kernel, name);
  }
  LayerPlan layer{.kind = LayerPlan::Kind::kConvolution,
                  .name = name,
                  .key = key,
                  .input = from,
                  .kernel = kernel,
                  .stride = stride,
                  .padding = padding,
                  .activation = activation,
                  .initialisation = initialisation,
                  .gain = kConvolutionGain};
  layer.output = {filters, Windows(from.height, kernel, stride, padding),
                  Windows(from.width, kernel, stride, padding)};
  layers_.push_back(std::move(layer));
}

void NetworkPlan::Add(const Linear& linear) {
  const int64_t inputs = output().size();
  if (inputs > std::numeric_limits<int>::max()) {
    throw UsageError("{}: {} gets {} inputs, expected at most {}",
                     layers_.empty() ? linear.key : layers_.back().key, linear.name, inputs,
                     std::numeric_limits<int>::max());
  }
  layers_.push_back({.kind = LayerPlan::Kind::kLinear,
                     .name = linear.name,
                     .key = linear.key,
                     .input = {int(inputs)},
                     .output = {linear.outputs},
                     .layer_norm = linear.layer_norm,
                     .activation = linear.activation,
                     .initialisation = linear.initialisation,
                     .gain = linear.gain});
}

std::vector<ParameterSpec> NetworkPlan::Parameters() const {
  std::vector<ParameterSpec> parameters;
  for (const LayerPlan& layer : layers_) Append(layer.Parameters(), &parameters);
  return parameters;
}

void Append(const std::vector<ParameterSpec>& more, std::vector<ParameterSpec>* parameters) {
  parameters->insert(parameters->end(), more.begin(), more.end());
}

}  // namespace shoal::nn
