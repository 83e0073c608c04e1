// SPDX-License-Identifier: Apache-2.0
#include "tests/common/nn/reference_network.h"

#include <cmath>
#include <cstring>

namespace shoal::nn::reference {

namespace {

Values Pixels(const NetworkPlan& encoder, int batch, const uint8_t* frames) {
  const MapShape& images = encoder.input();
  const int pool = encoder.layers()[0].kernel;
  const double shift = encoder.layers()[0].range == PixelRange::kCentred ? -0.5 : 0;
  Values x;
  for (int p = 0; p < batch * images.channels; ++p) {
    for (int i = 0; i < images.height / pool; ++i) {
      for (int j = 0; j < images.width / pool; ++j) {
        double sum = 0;
        for (int u = 0; u < pool; ++u) {
          for (int v = 0; v < pool; ++v) {
            sum += frames[(p * images.height + i * pool + u) * images.width + j * pool + v];
          }
        }
        x.push_back(sum / (255.0 * pool * pool) + shift);
      }
    }
  }
  return x;
}

// A map and its sides, worked out here, layer by layer; the plan gives kernels, strides, padding.
struct Map {
  Values values;
  int channels, height, width;
};

class MapNetwork {
 public:
  MapNetwork(const NetworkPlan& plan, const Parameters& parameters, int batch,
             Statistics statistics)
      : layers_(plan.layers()), parameters_(parameters), batch_(batch), statistics_(statistics) {}

  Values Run(Map pixels) {
    maps_.push_back(std::move(pixels));
    for (size_t i = 1; i < layers_.size(); ++i) maps_.push_back(Layer(layers_[i]));
    return maps_.back().values;
  }

 private:
  const Values& P(const std::string& name) const { return parameters_.at(name); }

  Map Layer(const LayerPlan& plan) const {
    const Map& x = maps_[size_t(plan.source)];
    if (plan.kind == LayerPlan::Kind::kMaxPool) {
      const PoolShape shape{batch_ * x.channels, x.height,    x.width,
                            plan.kernel,         plan.stride, plan.padding};
      return {MaxPoolForward(shape, x.values), x.channels, shape.out_height(), shape.out_width()};
    }
    if (plan.kind == LayerPlan::Kind::kAveragePool) {
      const int height = plan.output.height, width = plan.output.width;
      return {AveragePoolForward({batch_ * x.channels, x.height, x.width, height, width}, x.values),
              x.channels, height, width};
    }
    if (plan.kind == LayerPlan::Kind::kSpatialSoftmax) {
      return {Points({batch_ * x.channels, x.height, x.width, plan.sharpness}, x.values),
              x.channels, 1, 2};
    }
    return Convolution(plan, x);
  }

  Map Convolution(const LayerPlan& plan, const Map& x) const {
    const Values& weight = P(plan.name + ".weight");
    const int filters = int(weight.size()) / (x.channels * plan.kernel * plan.kernel);
    ConvShape shape{batch_, x.channels, x.height, x.width, filters, plan.stride};
    shape.kernel = plan.kernel;
    shape.padding = plan.padding;
    shape.relu = false;
    Map y{ConvForward(shape, x.values, weight,
                      plan.bias ? P(plan.name + ".bias") : Values(size_t(filters))),
          filters, shape.out_height(), shape.out_width()};
    if (!plan.batch_norm.empty()) {
      const Moments moments =
          statistics_ == Statistics::kBatch
              ? BatchMoments(batch_, y.values, filters)
              : Moments{P(plan.batch_norm + ".running_mean"), P(plan.batch_norm + ".running_var")};
      y.values = BatchNormForward(batch_, y.values, moments, P(plan.batch_norm + ".weight"),
                                  P(plan.batch_norm + ".bias"));
    }
    if (plan.skip != kNoLayer) y.values = Plus(y.values, maps_[size_t(plan.skip)].values);
    if (plan.activation == Activation::kRelu) y.values = Relu(y.values);
    return y;
  }

  const std::vector<LayerPlan>& layers_;
  const Parameters& parameters_;
  const int batch_;
  const Statistics statistics_;
  std::vector<Map> maps_;
};

}  // namespace

Parameters ToParameters(const TensorMap& tensors) {
  Parameters parameters;
  for (const auto& [name, tensor] : tensors) {
    if (tensor.dtype != "F32") continue;
    std::vector<float> values(tensor.data.size() / sizeof(float));
    std::memcpy(values.data(), tensor.data.data(), tensor.data.size());
    parameters[name] = Values(values.begin(), values.end());
  }
  return parameters;
}

Values Features(const NetworkPlan& encoder, const Parameters& parameters, int batch,
                const uint8_t* frames, Statistics statistics) {
  const int pool = encoder.layers()[0].kernel;
  const MapShape& images = encoder.input();
  return MapNetwork(encoder, parameters, batch, statistics)
      .Run({Pixels(encoder, batch, frames), images.channels, images.height / pool,
            images.width / pool});
}

Network::Network(const TensorMap& tensors, const NetworkConfig& config, const ObservationSpec& spec)
    : config_(config),
      spec_(spec),
      encoder_(PlanEncoder(config, spec)),
      relu_trunk_(config.trunk == "relu" || (config.trunk == "auto" && config.encoder == "nature")),
      parameters_(ToParameters(tensors)) {}

Values Network::Features(int batch, const uint8_t* frames) const {
  return reference::Features(encoder_, parameters_, batch, frames);
}

Values Network::Observation(const std::string& head, int batch, const Values& features,
                            const Values& vector) const {
  if (!spec_.HasPixels()) return vector;
  const std::string name = head + ".trunk";
  Values z = LinearForward(batch, features, P(name + ".weight"), P(name + ".bias"));
  if (relu_trunk_) return Beside(batch, Relu(z), vector);
  z = LayerNormForward(batch, z, P(name + ".norm.weight"), P(name + ".norm.bias"));
  return Beside(batch, Tanh(z), vector);
}

Values Network::Blocks(const std::string& name, int batch, Values x) const {
  for (int i = 0; i < config_.blocks; ++i) {
    const std::string block = name + ".block" + std::to_string(i);
    Values y = LayerNormForward(batch, x, P(block + ".norm.weight"), P(block + ".norm.bias"));
    y = Relu(LinearForward(batch, y, P(block + ".layer0.weight"), P(block + ".layer0.bias")));
    x = Plus(x, LinearForward(batch, y, P(block + ".layer1.weight"), P(block + ".layer1.bias")));
  }
  return LayerNormForward(batch, x, P(name + ".norm.weight"), P(name + ".norm.bias"));
}

Values Network::Mlp(const std::string& name, int batch, const Values& input) const {
  Values x = input;
  for (size_t i = 0; i < config_.hidden.size(); ++i) {
    const std::string layer = name + ".layer" + std::to_string(i);
    x = LinearForward(batch, x, P(layer + ".weight"), P(layer + ".bias"));
    if (config_.blocks > 0) continue;
    if (config_.layer_norm) {
      x = LayerNormForward(batch, x, P(layer + ".norm.weight"), P(layer + ".norm.bias"));
    }
    x = Relu(x);
  }
  if (config_.blocks > 0) x = Blocks(name, batch, std::move(x));
  return LinearForward(batch, x, P(name + ".output.weight"), P(name + ".output.bias"));
}

Network::Gaussian Network::Actor(int batch, const Values& features, const Values& vector) const {
  const Values output = Mlp("actor.mlp", batch, Observation("actor", batch, features, vector));
  const size_t actions = size_t(spec_.action_size);
  Gaussian gaussian;
  for (size_t b = 0; b < size_t(batch); ++b) {
    for (size_t j = 0; j < actions; ++j) {
      gaussian.mean.push_back(output[b * 2 * actions + j]);
      gaussian.log_std.push_back(-5 + 3.5 * (std::tanh(output[b * 2 * actions + actions + j]) + 1));
    }
  }
  return gaussian;
}

Values Network::Q(const std::string& head, int number, int batch, const Values& features,
                  const Values& vector, const Values& action) const {
  const Values input = Beside(batch, Observation(head, batch, features, vector), action);
  return Mlp(head + ".q" + std::to_string(number), batch, input);
}

Network::TwinQ Network::Critic(const std::string& head, int batch, const Values& features,
                               const Values& vector, const Values& action) const {
  return {Q(head, 1, batch, features, vector, action), Q(head, 2, batch, features, vector, action)};
}

}  // namespace shoal::nn::reference
