// A network as a value: its layers in order, each with geometry, normalisation, activation and the
// way its parameters start. Shapes are computed here and nowhere else; parameters, layers, the size
// of a policy and the checks of the configuration follow from the plan.
//
// Dimensions: C channels, (H, W) of a map, N filters, O outputs, k kernel, s stride, p padding.
//
//   pixels        (C, H, W) u8 -> (C, H/k, W/k)           mean over k x k, scaled to [-0.5, 0.5]
//   convolution   (C, H, W) -> (N, (H + 2p - k)/s + 1, ...)     weight (N, C, k, k), bias (N)
//   linear        all numbers of its input in row-major order -> (O)     weight (O, I), bias (O)
//
// then LayerNorm over a linear layer's outputs (norm.weight, norm.bias) and the activation, where
// the layer has them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shoal::nn {

// How a parameter starts: a constant, orthogonal rows or columns of length `scale`, or uniform in
// [-scale, scale].
struct Start {
  enum class Kind { kZeros, kOnes, kOrthogonal, kUniform };
  Kind kind = Kind::kZeros;
  double scale = 1;
};

struct ParameterSpec {
  std::string name;
  std::vector<int64_t> shape;
  Start start = {};
};

// kOrthogonal: weights orthogonal of the layer's gain, biases 0 (Saxe et al. 2013,
// arXiv:1312.6120). kPyTorch: what PyTorch's layers do by themselves, weights and biases uniform
// within 1 / sqrt(inputs of one output). Norms start at 1 and 0 in both.
enum class Initialisation { kOrthogonal, kPyTorch };

enum class Activation { kNone, kRelu, kTanh };

struct MapShape {
  int channels = 0, height = 1, width = 1;

  int64_t size() const { return int64_t{channels} * height * width; }
  bool operator==(const MapShape&) const = default;
};

struct LayerPlan {
  enum class Kind { kPixels, kConvolution, kLinear };

  Kind kind = Kind::kLinear;
  std::string name;      // of its parameters: NAME.weight, NAME.bias, NAME.norm.*
  std::string key;       // the configuration key that says how large it is
  MapShape input = {};   // linear: (I, 1, 1)
  MapShape output = {};  // linear: (O, 1, 1)
  int kernel = 1, stride = 1, padding = 0;
  bool layer_norm = false;
  Activation activation = Activation::kNone;
  Initialisation initialisation = Initialisation::kOrthogonal;
  double gain = 1;  // of an orthogonal weight

  std::vector<ParameterSpec> Parameters() const;
};

class NetworkPlan {
 public:
  NetworkPlan() = default;
  explicit NetworkPlan(const MapShape& input) : input_(input) {}

  // Each appends a layer that reads the output of the last one. Throws Error (kUsage) where a map
  // is too small for it, or its input too large to be counted.
  void AddPixels(int pool, const std::string& key);
  struct Convolution {
    std::string name, key;
    int filters, kernel, stride, padding = 0;
    Activation activation = Activation::kRelu;
    Initialisation initialisation = Initialisation::kOrthogonal;
  };
  void Add(const Convolution& convolution);
  struct Linear {
    std::string name, key;
    int outputs;
    bool layer_norm = false;
    Activation activation = Activation::kNone;
    Initialisation initialisation = Initialisation::kOrthogonal;
    double gain = 1;
  };
  void Add(const Linear& linear);

  const std::vector<LayerPlan>& layers() const { return layers_; }
  const MapShape& input() const { return input_; }
  const MapShape& output() const { return layers_.empty() ? input_ : layers_.back().output; }
  // Of all layers, in order.
  std::vector<ParameterSpec> Parameters() const;

 private:
  MapShape input_;
  std::vector<LayerPlan> layers_;
};

// `more` behind `parameters`.
void Append(const std::vector<ParameterSpec>& more, std::vector<ParameterSpec>* parameters);

}  // namespace shoal::nn
