#include "tests/common/nn/reference_network.h"

#include <cmath>
#include <cstring>

namespace shoal::nn::reference {

Network::Network(const TensorMap& tensors, const NetworkConfig& config, const ObservationSpec& spec)
    : config_(config), spec_(spec), encoder_(PlanEncoder(config, spec)) {
  relu_trunk_ = config.trunk == "relu" || (config.trunk == "auto" && config.encoder == "nature");
  for (const auto& [name, tensor] : tensors) {
    if (tensor.dtype != "F32") continue;
    std::vector<float> values(tensor.data.size() / sizeof(float));
    std::memcpy(values.data(), tensor.data.data(), tensor.data.size());
    parameters_[name] = Values(values.begin(), values.end());
  }
}

// Sizes are worked out here, layer by layer; the plan gives kernels, strides and padding.
Values Network::Features(int batch, const uint8_t* frames) const {
  const std::vector<LayerPlan>& layers = encoder_.layers();
  const int pool = layers[0].kernel;
  ConvShape shape{batch, spec_.stack * spec_.channels, spec_.height / pool, spec_.width / pool, 0,
                  0};
  Values x;
  for (int p = 0; p < batch * shape.channels; ++p) {
    for (int i = 0; i < shape.height; ++i) {
      for (int j = 0; j < shape.width; ++j) {
        double sum = 0;
        for (int u = 0; u < pool; ++u) {
          for (int v = 0; v < pool; ++v) {
            sum += frames[(p * spec_.height + i * pool + u) * spec_.width + j * pool + v];
          }
        }
        x.push_back(sum / (255.0 * pool * pool) - 0.5);
      }
    }
  }
  for (size_t layer = 1; layer < layers.size(); ++layer) {
    const LayerPlan& plan = layers[layer];
    const Values& bias = P(plan.name + ".bias");
    shape.filters = int(bias.size());
    shape.kernel = plan.kernel;
    shape.stride = plan.stride;
    shape.padding = plan.padding;
    shape.relu = plan.activation == Activation::kRelu;
    x = ConvForward(shape, x, P(plan.name + ".weight"), bias);
    const int height = shape.out_height(), width = shape.out_width();
    shape.channels = shape.filters;
    shape.height = height;
    shape.width = width;
  }
  return x;
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

Values Network::Mlp(const std::string& name, int batch, const Values& input) const {
  Values x = input;
  for (size_t i = 0; i < config_.hidden.size(); ++i) {
    const std::string layer = name + ".layer" + std::to_string(i);
    x = LinearForward(batch, x, P(layer + ".weight"), P(layer + ".bias"));
    if (config_.layer_norm) {
      x = LayerNormForward(batch, x, P(layer + ".norm.weight"), P(layer + ".norm.bias"));
    }
    x = Relu(x);
  }
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

Network::TwinQ Network::Critic(const std::string& head, int batch, const Values& features,
                               const Values& vector, const Values& action) const {
  const Values input = Beside(batch, Observation(head, batch, features, vector), action);
  return {Mlp(head + ".q1", batch, input), Mlp(head + ".q2", batch, input)};
}

}  // namespace shoal::nn::reference
