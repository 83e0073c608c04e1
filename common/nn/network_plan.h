// SPDX-License-Identifier: Apache-2.0
// Description of a network: its layers in order, each with geometry, normalisation, activation and
// initialisation. Shapes are computed only here. Parameters, layers, the size of a policy and the
// checks of the configuration are derived from the plan.
//
// Dimensions: C channels, (H, W) of a map, N filters, I inputs, O outputs, k kernel, s stride, p
// padding.
//
//   pixels        (C, H, W) u8 -> (C, H/k, W/k)           mean over k x k, scaled to a range of 1
//   convolution   (C, H, W) -> (N, (H + 2p - k)/s + 1, ...)     weight (N, C, k, k), bias (N)
//   max pool      (C, H, W) -> (C, (H + 2p - k)/s + 1, ...)     largest of k x k
//   average pool  (C, H, W) -> (C, h, w)                    for any H and W
//   spatial softmax  (C, H, W) -> (C, 1, 2)   position of each channel's peak: spatial_softmax.h
//   linear        all numbers of its input in row-major order -> (O)     weight (O, I), bias (O)
//   layer norm    (I) -> (I): layer_norm.h                               weight (I), bias (I)
//
// A linear layer may be followed by LayerNorm over its outputs (norm.weight, norm.bias). A
// convolution may be followed by batch normalisation of its channels (weight, bias, running_mean,
// running_var, all (N)). The output of an earlier layer may be added to the normalised map, or to
// the output of a linear layer without LayerNorm. The activation is the last operation.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::nn {

// Initial value of a parameter: a constant, orthogonal rows or columns of length `scale`, uniform
// in [-scale, scale], or normal with deviation `scale`.
struct Start {
  enum class Kind { kZeros, kOnes, kOrthogonal, kUniform, kNormal };
  Kind kind = Kind::kZeros;
  double scale = 1;
};

struct ParameterSpec {
  std::string name;
  std::vector<int64_t> shape;
  Start start = {};
  // True for a running statistic, which forward passes measure and no loss trains. Moving averages
  // of parameters copy it.
  bool statistic = false;
};

// Endings of the names of batch normalisation's running averages. No other name has such an ending.
inline constexpr std::string_view kRunningMean = ".running_mean", kRunningVariance = ".running_var";

// kOrthogonal: orthogonal weights with the layer's gain, biases 0 (Saxe et al. 2013,
// arXiv:1312.6120). kPyTorch: the default of PyTorch's layers, weights and biases uniform in [-b,
// b] with b = 1 / sqrt(inputs of one output). kKaiming: normal weights with variance 2 / (N k^2),
// biases 0 (He et al. 2015, arXiv:1502.01852, fan-out). The weights of norms always start at 1, the
// biases of norms at 0.
enum class Initialisation { kOrthogonal, kPyTorch, kKaiming };

enum class Activation { kNone, kRelu, kTanh, kElu };

struct MapShape {
  int channels = 0, height = 1, width = 1;

  int64_t size() const { return int64_t{channels} * height * width; }
  bool operator==(const MapShape&) const = default;
};

// Range of scaled pixels: [-0.5, 0.5] or [0, 1].
enum class PixelRange { kCentred, kUnit };

// Values in place of a layer's index. kPreviousLayer: the layer that was added last. kNoLayer: no
// layer.
inline constexpr int kPreviousLayer = -1, kNoLayer = -1;

struct LayerPlan {
  enum class Kind {
    kPixels,
    kConvolution,
    kMaxPool,
    kAveragePool,
    kSpatialSoftmax,
    kLinear,
    kLayerNorm
  };

  Kind kind = Kind::kLinear;
  std::string name;       // prefix of its parameters: NAME.weight, NAME.bias, NAME.norm.*
  std::string key;        // configuration key that sets its size
  MapShape input = {};    // linear: (I, 1, 1)
  MapShape output = {};   // linear: (O, 1, 1)
  int source = kNoLayer;  // layer whose output is the input; kNoLayer: the network's input
  int kernel = 1, stride = 1, padding = 0;
  double sharpness = 1;                     // spatial softmax only
  PixelRange range = PixelRange::kCentred;  // pixels only
  bool bias = true;
  bool layer_norm = false;
  std::string batch_norm = {};  // prefix of the names BATCH_NORM.weight, ...; empty: no batch norm
  int skip = kNoLayer;          // layer whose output is added before the activation
  Activation activation = Activation::kNone;
  Initialisation initialisation = Initialisation::kOrthogonal;
  double gain = 1;  // scale of an orthogonal weight

  std::vector<ParameterSpec> Parameters() const;
};

class NetworkPlan {
 public:
  NetworkPlan() = default;
  explicit NetworkPlan(const MapShape& input) : input_(input) {}

  // Each function appends a layer and returns its index. The layer reads the output of the last
  // layer, or of `source`. Throws Error (kUsage) if a map is too small for the layer, or if the
  // size of the layer's input overflows.
  int AddPixels(int pool, const std::string& key, PixelRange range = PixelRange::kCentred);
  struct Convolution {
    std::string name, key;
    int filters, kernel, stride, padding = 0;
    Activation activation = Activation::kRelu;
    Initialisation initialisation = Initialisation::kOrthogonal;
    bool bias = true;
    std::string batch_norm = {};  // see LayerPlan; needs bias = false
    int source = kPreviousLayer;
    int skip = kNoLayer;  // layer of the same shape; needs batch normalisation
  };
  int Add(const Convolution& convolution);
  struct MaxPool {
    std::string name, key;
    int kernel, stride, padding = 0;
  };
  int Add(const MaxPool& pool);
  struct AveragePool {
    std::string name, key;
    int height, width;  // size of the output
  };
  int Add(const AveragePool& pool);
  struct SpatialSoftmax {
    std::string name, key;
    double sharpness;
  };
  int Add(const SpatialSoftmax& softmax);
  struct Linear {
    std::string name, key;
    int outputs;
    bool layer_norm = false;
    Activation activation = Activation::kNone;
    Initialisation initialisation = Initialisation::kOrthogonal;
    double gain = 1;
    int skip = kNoLayer;  // layer of as many outputs; needs layer_norm = false
  };
  int Add(const Linear& linear);
  struct LayerNorm {
    std::string name, key;
  };
  int Add(const LayerNorm& norm);

  const std::vector<LayerPlan>& layers() const { return layers_; }
  const MapShape& input() const { return input_; }
  const MapShape& output() const { return layers_.empty() ? input_ : layers_.back().output; }
  // Parameters of all layers, in order.
  std::vector<ParameterSpec> Parameters() const;

 private:
  int Append(LayerPlan layer);

  MapShape input_;
  std::vector<LayerPlan> layers_;
};

// Appends `more` to `parameters`.
void Append(const std::vector<ParameterSpec>& more, std::vector<ParameterSpec>* parameters);

}  // namespace shoal::nn
