// SPDX-License-Identifier: Apache-2.0
#include "common/nn/network_plan.h"

#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::nn {
namespace {

// The usual gain before a ReLU, which halves the variance.
const double kConvolutionGain = std::sqrt(2.0);

// Number of places of a window along one side of a map.
int Windows(int side, int kernel, int stride, int padding) {
  return (side + 2 * padding - kernel) / stride + 1;
}

Start WeightStart(const LayerPlan& layer, int64_t inputs) {
  switch (layer.initialisation) {
    case Initialisation::kPyTorch:
      return {Start::Kind::kUniform, 1 / std::sqrt(double(inputs))};
    case Initialisation::kKaiming:
      return {Start::Kind::kNormal,
              std::sqrt(2.0 / (double(layer.output.channels) * layer.kernel * layer.kernel))};
    default:
      return {Start::Kind::kOrthogonal, layer.gain};
  }
}

Start BiasStart(const LayerPlan& layer, int64_t inputs) {
  if (layer.initialisation == Initialisation::kPyTorch) return WeightStart(layer, inputs);
  return {Start::Kind::kZeros};
}

void CheckWindow(const MapShape& from, int kernel, int padding, const std::string& key,
                 const std::string& what) {
  if (from.height + 2 * padding >= kernel && from.width + 2 * padding >= kernel) return;
  throw UsageError("{}: a {}x{} map is smaller than the {}x{} {}", key, from.height, from.width,
                   kernel, kernel, what);
}

}  // namespace

std::vector<ParameterSpec> LayerPlan::Parameters() const {
  if (kind == Kind::kLayerNorm) {
    return {{name + ".weight", {output.channels}, {Start::Kind::kOnes}},
            {name + ".bias", {output.channels}, {Start::Kind::kZeros}}};
  }
  if (kind != Kind::kConvolution && kind != Kind::kLinear) return {};
  const int64_t outputs = output.channels;
  std::vector<int64_t> weight{outputs, input.channels};
  int64_t inputs = input.channels;  // of each output
  if (kind == Kind::kConvolution) {
    weight.insert(weight.end(), {kernel, kernel});
    inputs *= int64_t{kernel} * kernel;
  }
  std::vector<ParameterSpec> parameters{{name + ".weight", weight, WeightStart(*this, inputs)}};
  if (bias) parameters.push_back({name + ".bias", {outputs}, BiasStart(*this, inputs)});
  if (layer_norm) {
    parameters.push_back({name + ".norm.weight", {outputs}, {Start::Kind::kOnes}});
    parameters.push_back({name + ".norm.bias", {outputs}, {Start::Kind::kZeros}});
  }
  if (!batch_norm.empty()) {
    parameters.push_back({batch_norm + ".weight", {outputs}, {Start::Kind::kOnes}});
    parameters.push_back({batch_norm + ".bias", {outputs}, {Start::Kind::kZeros}});
    parameters.push_back({batch_norm + std::string(kRunningMean),
                          {outputs},
                          {Start::Kind::kZeros},
                          /*statistic=*/true});
    parameters.push_back({batch_norm + std::string(kRunningVariance),
                          {outputs},
                          {Start::Kind::kOnes},
                          /*statistic=*/true});
  }
  return parameters;
}

int NetworkPlan::Append(LayerPlan layer) {
  layers_.push_back(std::move(layer));
  return int(layers_.size()) - 1;
}

int NetworkPlan::AddPixels(int pool, const std::string& key, PixelRange range) {
  CHECK(layers_.empty()) << "pixels are what a network begins with";
  return Append({.kind = LayerPlan::Kind::kPixels,
                 .name = "pixels",
                 .key = key,
                 .input = input_,
                 .output = {input_.channels, input_.height / pool, input_.width / pool},
                 .kernel = pool,
                 .stride = pool,
                 .range = range});
}

int NetworkPlan::Add(const Convolution& convolution) {
  const auto& [name, key, filters, kernel, stride, padding, activation, initialisation, bias,
               batch_norm, asked_source, skip] = convolution;
  const int last = int(layers_.size()) - 1;
  const int source = asked_source == kPreviousLayer ? last : asked_source;
  CHECK(source <= last && skip <= last) << name << " reads a layer that follows it";
  const MapShape from = source == last ? output() : layers_[size_t(source)].output;
  CheckWindow(from, kernel, padding, key, "kernel of " + name);
  const MapShape to{filters, Windows(from.height, kernel, stride, padding),
                    Windows(from.width, kernel, stride, padding)};
  CHECK(batch_norm.empty() || !bias) << name << ": batch normalisation takes a bias out again";
  CHECK(skip == kNoLayer || (!batch_norm.empty() && layers_[size_t(skip)].output == to)) << name;
  return Append({.kind = LayerPlan::Kind::kConvolution,
                 .name = name,
                 .key = key,
                 .input = from,
                 .output = to,
                 .source = source,
                 .kernel = kernel,
                 .stride = stride,
                 .padding = padding,
                 .bias = bias,
                 .batch_norm = batch_norm,
                 .skip = skip,
                 .activation = activation,
                 .initialisation = initialisation,
                 .gain = kConvolutionGain});
}

int NetworkPlan::Add(const MaxPool& pool) {
  const MapShape from = output();
  CheckWindow(from, pool.kernel, pool.padding, pool.key, "window of " + pool.name);
  return Append(
      {.kind = LayerPlan::Kind::kMaxPool,
       .name = pool.name,
       .key = pool.key,
       .input = from,
       .output = {from.channels, Windows(from.height, pool.kernel, pool.stride, pool.padding),
                  Windows(from.width, pool.kernel, pool.stride, pool.padding)},
       .source = int(layers_.size()) - 1,
       .kernel = pool.kernel,
       .stride = pool.stride,
       .padding = pool.padding});
}

int NetworkPlan::Add(const AveragePool& pool) {
  return Append({.kind = LayerPlan::Kind::kAveragePool,
                 .name = pool.name,
                 .key = pool.key,
                 .input = output(),
                 .output = {output().channels, pool.height, pool.width},
                 .source = int(layers_.size()) - 1});
}

int NetworkPlan::Add(const SpatialSoftmax& softmax) {
  return Append({.kind = LayerPlan::Kind::kSpatialSoftmax,
                 .name = softmax.name,
                 .key = softmax.key,
                 .input = output(),
                 .output = {output().channels, 1, 2},
                 .source = int(layers_.size()) - 1,
                 .sharpness = softmax.sharpness});
}

int NetworkPlan::Add(const Linear& linear) {
  const int64_t inputs = output().size();
  if (inputs > std::numeric_limits<int>::max()) {
    throw UsageError("{}: {} gets {} inputs, expected at most {}",
                     layers_.empty() ? linear.key : layers_.back().key, linear.name, inputs,
                     std::numeric_limits<int>::max());
  }
  const int skip = linear.skip;
  CHECK(skip == kNoLayer ||
        (!linear.layer_norm && layers_.at(size_t(skip)).output == MapShape{linear.outputs}))
      << linear.name;
  return Append({.kind = LayerPlan::Kind::kLinear,
                 .name = linear.name,
                 .key = linear.key,
                 .input = {int(inputs)},
                 .output = {linear.outputs},
                 .source = int(layers_.size()) - 1,
                 .layer_norm = linear.layer_norm,
                 .skip = skip,
                 .activation = linear.activation,
                 .initialisation = linear.initialisation,
                 .gain = linear.gain});
}

int NetworkPlan::Add(const LayerNorm& norm) {
  return Append({.kind = LayerPlan::Kind::kLayerNorm,
                 .name = norm.name,
                 .key = norm.key,
                 .input = output(),
                 .output = output(),
                 .source = int(layers_.size()) - 1});
}

std::vector<ParameterSpec> NetworkPlan::Parameters() const {
  std::vector<ParameterSpec> parameters;
  for (const LayerPlan& layer : layers_) nn::Append(layer.Parameters(), &parameters);
  return parameters;
}

void Append(const std::vector<ParameterSpec>& more, std::vector<ParameterSpec>* parameters) {
  parameters->insert(parameters->end(), more.begin(), more.end());
}

}  // namespace shoal::nn
