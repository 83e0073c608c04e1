// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_policy.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/nn/vector_scale.h"

namespace shoal::launch {
namespace {

using nn::Activation;
using nn::LayerPlan;
using nn::MapShape;

constexpr float kNormEpsilon = 1e-5f;  // as in layer_norm.h and batch_norm.h

// nn::AveragePool along one side as a row-major matrix (inputs, outputs) of shares.
std::vector<float> PoolShares(int inputs, int outputs) {
  std::vector<float> shares(size_t(inputs) * size_t(outputs), 0.f);
  for (int i = 0; i < outputs; ++i) {
    const int64_t begin = int64_t{i} * inputs / outputs;
    const int64_t end = (int64_t{i + 1} * inputs + outputs - 1) / outputs;
    for (int64_t u = begin; u < end; ++u) {
      shares[size_t(u) * size_t(outputs) + size_t(i)] = 1.f / float(end - begin);
    }
  }
  return shares;
}

std::vector<float> Transposed(const std::vector<float>& matrix, int rows, int columns) {
  std::vector<float> result(matrix.size());
  for (size_t i = 0; i < size_t(rows); ++i) {
    for (size_t j = 0; j < size_t(columns); ++j) {
      result[j * size_t(rows) + i] = matrix[i * size_t(columns) + j];
    }
  }
  return result;
}

using Shape = std::vector<int64_t>;

std::vector<float> Ones(int64_t n) { return std::vector<float>(size_t(n), 1.f); }

// Coordinates of nn::SpatialSoftmax along one side.
std::vector<float> Coordinates(int64_t side) {
  std::vector<float> coordinates(size_t(side), 0.f);
  for (int64_t i = 0; i < side && side > 1; ++i) {
    coordinates[size_t(i)] = 2 * float(i) / float(side - 1) - 1;
  }
  return coordinates;
}

// A matrix of two columns. `values` are the second or the first column; the other is 0.
std::vector<float> BesideZeros(const std::vector<float>& values, bool second) {
  std::vector<float> matrix(values.size() * 2, 0.f);
  for (size_t i = 0; i < values.size(); ++i) matrix[2 * i + size_t(second)] = values[i];
  return matrix;
}

// Appends nodes to a model. Values have names; each function returns the name of its output.
class GraphWriter {
 public:
  explicit GraphWriter(OnnxModel* model) : model_(*model) {}

  std::string Add(const std::string& op, std::vector<std::string> inputs,
                  std::map<std::string, OnnxAttribute> attributes = {}) {
    std::string output = fmt::format("/{}_{}", op, model_.nodes.size());
    model_.nodes.push_back({op, std::move(inputs), output, std::move(attributes)});
    return output;
  }

  std::string Constant(const std::string& name, OnnxTensor tensor) {
    model_.constants[name] = std::move(tensor);
    return name;
  }
  std::string Number(const std::string& name, float value) { return Constant(name, {{}, {value}}); }

  std::string Concatenate(const std::vector<std::string>& values) {
    if (values.size() == 1) return values[0];
    return Add("Concat", values, {{"axis", int64_t{1}}});
  }

  std::string Activate(Activation activation, const std::string& input) {
    switch (activation) {
      case Activation::kRelu:
        return Add("Relu", {input});
      case Activation::kTanh:
        return Add("Tanh", {input});
      case Activation::kElu:
        return Add("Elu", {input});
      case Activation::kNone:
        break;
    }
    return input;
  }

  // Adds layers whose parameters are already constants. Returns the output of the last layer.
  std::string AddLayers(const nn::NetworkPlan& plan, const std::string& input) {
    std::vector<std::string> outputs;
    for (const LayerPlan& layer : plan.layers()) {
      const std::string& source =
          layer.source == nn::kNoLayer ? input : outputs[size_t(layer.source)];
      const std::string skip = layer.skip == nn::kNoLayer ? "" : outputs[size_t(layer.skip)];
      outputs.push_back(AddLayer(layer, source, skip));
    }
    return outputs.empty() ? input : outputs.back();
  }

 private:
  std::string AddLayer(const LayerPlan& layer, const std::string& source, const std::string& skip) {
    switch (layer.kind) {
      case LayerPlan::Kind::kPixels:
        return AddPixels(layer, source);
      case LayerPlan::Kind::kConvolution:
        return AddConvolution(layer, source, skip);
      case LayerPlan::Kind::kMaxPool:
        return Add("MaxPool", {source}, Window(layer));
      case LayerPlan::Kind::kAveragePool:
        return AddAveragePool(layer, source);
      case LayerPlan::Kind::kSpatialSoftmax:
        return AddSpatialSoftmax(layer, source);
      case LayerPlan::Kind::kLinear:
        return AddLinear(layer, source, skip);
      case LayerPlan::Kind::kLayerNorm:
        return AddLayerNorm(layer.name, source);
    }
    CHECK(false) << layer.name;
    return "";
  }

  static std::map<std::string, OnnxAttribute> Window(const LayerPlan& layer) {
    return {{"kernel_shape", std::vector<int64_t>(2, layer.kernel)},
            {"strides", std::vector<int64_t>(2, layer.stride)},
            {"pads", std::vector<int64_t>(4, layer.padding)}};
  }

  std::string AddPixels(const LayerPlan& layer, const std::string& source) {
    std::string value = Add("Cast", {source}, {{"to", int64_t(OnnxPort::Type::kF32)}});
    if (layer.kernel > 1) {
      const std::vector<int64_t> side(2, layer.kernel);
      value = Add("AveragePool", {value}, {{"kernel_shape", side}, {"strides", side}});
    }
    value = Add("Mul", {value, Number("pixels.scale", 1.f / 255)});
    if (layer.range == nn::PixelRange::kUnit) return value;
    return Add("Sub", {value, Number("pixels.centre", 0.5f)});
  }

  std::string AddConvolution(const LayerPlan& layer, const std::string& source,
                             const std::string& skip) {
    std::vector<std::string> inputs{source, layer.name + ".weight"};
    if (layer.bias) inputs.push_back(layer.name + ".bias");
    std::string value = Add("Conv", inputs, Window(layer));
    if (const std::string& norm = layer.batch_norm; !norm.empty()) {
      value = Add("BatchNormalization",
                  {value, norm + ".weight", norm + ".bias", norm + std::string(nn::kRunningMean),
                   norm + std::string(nn::kRunningVariance)},
                  {{"epsilon", kNormEpsilon}});
    }
    if (!skip.empty()) value = Add("Add", {value, skip});
    return Activate(layer.activation, value);
  }

  // Windows of rows and columns are independent of each other, so pooling is a product from either
  // side.
  std::string AddAveragePool(const LayerPlan& layer, const std::string& source) {
    const MapShape& from = layer.input;
    const MapShape& to = layer.output;
    const std::string columns = Constant(
        layer.name + ".columns", {{from.width, to.width}, PoolShares(from.width, to.width)});
    const std::string rows =
        Constant(layer.name + ".rows",
                 {{to.height, from.height},
                  Transposed(PoolShares(from.height, to.height), from.height, to.height)});
    return Add("MatMul", {rows, Add("MatMul", {source, columns})});
  }

  // nn::SpatialSoftmax by products from either side, which keep a map's planes apart. First e =
  // exp(s x - largest value of the plane), then both means of coordinates at once, (N, C, 1, 2).
  std::string AddSpatialSoftmax(const LayerPlan& layer, const std::string& source) {
    const int64_t height = layer.input.height, width = layer.input.width;
    const auto constant = [&](const char* part, const Shape& shape, std::vector<float> values) {
      return Constant(layer.name + "." + part, {shape, std::move(values)});
    };
    const auto between = [&](const std::string& rows, const std::string& value,
                             const std::string& columns) {
      return Add("MatMul", {rows, Add("MatMul", {value, columns})});
    };
    const std::string scaled =
        Add("Mul", {source, Number(layer.name + ".sharpness", float(layer.sharpness))});
    const std::string largest =
        between(constant("height", {height, 1}, Ones(height)), Add("GlobalMaxPool", {scaled}),
                constant("width", {1, width}, Ones(width)));
    const std::string weights = Add("Exp", {Add("Sub", {scaled, largest})});
    const std::string rows = constant("rows", {1, height}, Ones(height));
    const std::string sum =
        between(rows, weights, constant("columns", {width, 2}, Ones(2 * width)));
    const std::string across = between(
        rows, weights, constant("across", {width, 2}, BesideZeros(Coordinates(width), false)));
    const std::string down =
        between(constant("down", {1, height}, Coordinates(height)), weights,
                constant("second", {width, 2}, BesideZeros(Ones(width), true)));
    return Add("Div", {Add("Add", {across, down}), sum});
  }

  std::string AddLinear(const LayerPlan& layer, const std::string& source,
                        const std::string& skip) {
    std::string value = Add("Gemm", {source, layer.name + ".weight", layer.name + ".bias"},
                            {{"transB", int64_t{1}}});
    if (layer.layer_norm) value = AddLayerNorm(layer.name + ".norm", value);
    if (!skip.empty()) value = Add("Add", {value, skip});
    return Activate(layer.activation, value);
  }

  // `name`: prefix of the parameters.
  std::string AddLayerNorm(const std::string& name, const std::string& source) {
    return Add("LayerNormalization", {source, name + ".weight", name + ".bias"},
               {{"axis", int64_t{-1}}, {"epsilon", kNormEpsilon}});
  }

  OnnxModel& model_;
};

void AddPorts(const ObservationSpec& spec, OnnxModel* model) {
  if (spec.HasPixels()) {
    model->inputs.push_back({.name = kPixelsInput,
                             .type = OnnxPort::Type::kU8,
                             .shape = {spec.InputChannels(), spec.height, spec.width}});
  }
  for (const BlockSpec& block : spec.blocks) {
    if (!block.observed || block.size == 0) continue;
    if (block.name == kPixelsInput || block.name == kActionOutput) {
      throw UsageError("task {}: a block called '{}' has the name of another input or output",
                       spec.task, block.name);
    }
    model->inputs.push_back({.name = block.name, .shape = {block.size}});
  }
  model->output = {.name = kActionOutput, .shape = {spec.action_size}};
}

// Adds the parameters of encoder and actor. The outputs of a Gaussian are means and deviations; the
// rows of the deviations are left out.
void AddParameters(const std::vector<nn::ParameterSpec>& specs, const nn::ActorPlan& actor,
                   nn::ParameterSet* set, OnnxModel* model) {
  const std::string output = actor.mlps[0].layers().back().name;
  for (const nn::ParameterSpec& spec : specs) {
    if (spec.name == actor.name + ".log_std") continue;
    OnnxTensor constant{.shape = spec.shape};
    if (spec.name.starts_with(output + ".")) constant.shape[0] = actor.action_size;
    constant.values.resize(Count(constant.shape));
    std::copy_n(set->Find(spec.name).value(), constant.values.size(), constant.values.begin());
    model->constants[spec.name] = std::move(constant);
  }
}

// Builds the policy's vector from its blocks; empty if the policy has no blocks.
std::string AddVector(const std::optional<nn::VectorScale>& scale, const OnnxModel& model,
                      GraphWriter* graph) {
  std::vector<std::string> blocks;
  for (const OnnxPort& input : model.inputs) {
    if (input.name != kPixelsInput) blocks.push_back(input.name);
  }
  if (blocks.empty()) return "";
  std::string vector = graph->Concatenate(blocks);
  if (!scale) return vector;
  const auto row = [](std::span<const float> values) {
    return OnnxTensor{{int64_t(values.size())}, {values.begin(), values.end()}};
  };
  const std::string centred =
      graph->Add("Sub", {vector, graph->Constant("observation.mean", row(scale->mean()))});
  const std::string scaled =
      graph->Add("Mul", {centred, graph->Constant("observation.factor", row(scale->factor()))});
  return graph->Add("Clip", {scaled, graph->Number("observation.low", -nn::VectorScale::kLimit),
                             graph->Number("observation.high", nn::VectorScale::kLimit)});
}

std::map<std::string, std::string> MetadataOf(const policy::CheckpointPolicy& policy) {
  const ObservationSpec& spec = policy.description.spec;
  return {{"task", spec.task},
          {"algorithm", policy.description.algorithm},
          {"cameras", fmt::format("{}", fmt::join(spec.cameras, ","))},
          {"stack", std::to_string(spec.stack)},
          {"goal_picture", spec.goal_picture ? "1" : "0"},
          {"updates", std::to_string(policy.state.updates)},
          {"env_steps", std::to_string(policy.state.env_steps)}};
}

}  // namespace

OnnxModel PolicyToOnnx(const policy::CheckpointPolicy& policy) {
  const ObservationSpec& spec = policy.description.spec;
  const nn::NetworkPlan encoder = policy.description.Encoder();
  const nn::ActorPlan actor = policy.description.Actor();
  std::vector<nn::ParameterSpec> specs = encoder.Parameters();
  nn::Append(actor.Parameters(), &specs);
  nn::ParameterSet set(specs, nn::ParameterSet::Use::kInference);
  set.Import(policy.tensors, "", kPolicyFile, set.values());

  OnnxModel model{.metadata = MetadataOf(policy)};
  AddPorts(spec, &model);
  AddParameters(specs, actor, &set, &model);
  GraphWriter graph(&model);
  std::vector<std::string> columns;
  if (spec.HasPixels()) {
    const std::string features =
        graph.Add("Flatten", {graph.AddLayers(encoder, kPixelsInput)}, {{"axis", int64_t{1}}});
    columns.push_back(graph.AddLayers(actor.trunk, features));
  }
  const auto scale = nn::ReadVectorScale(policy.tensors, spec.VectorSize(), kPolicyFile);
  if (const std::string vector = AddVector(scale, model, &graph); !vector.empty()) {
    columns.push_back(vector);
  }
  const std::string mean = graph.AddLayers(actor.mlps[0], graph.Concatenate(columns));
  if (actor.output == nn::ActorOutput::kUnsquashed) {
    graph.Add("Clip", {mean, graph.Number("action.low", -1), graph.Number("action.high", 1)});
  } else {
    graph.Add("Tanh", {mean});
  }
  model.nodes.back().output = kActionOutput;
  return model;
}

}  // namespace shoal::launch
