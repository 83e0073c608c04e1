// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/sb3_policy.h"

#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/nn/vector_scale.h"
#include "launch/tools/export/torch_file.h"
#include "launch/tools/export/zip_archive.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {
namespace {

using nn::ActorOutput;

// Stable-Baselines3's names for the parameters of a policy with this output.
struct Sb3Names {
  std::vector<std::string> extractors;
  std::string mlp;           // name before a hidden layer's number
  std::string output_layer;  // name of the action's layer; empty: the MLP's next number
};

const Sb3Names& NamesOf(ActorOutput output) {
  static const std::vector<std::string> actors{"actor.features_extractor"};
  static const Sb3Names gaussian{actors, "actor.latent_pi.", "actor.mu"};
  static const Sb3Names deterministic{actors, "actor.mu.", ""};
  static const Sb3Names unsquashed{
      {"features_extractor", "pi_features_extractor"}, "mlp_extractor.policy_net.", "action_net"};
  switch (output) {
    case ActorOutput::kGaussian:
      return gaussian;
    case ActorOutput::kDeterministic:
      return deterministic;
    case ActorOutput::kUnsquashed:
      break;
  }
  return unsquashed;
}

// Stable-Baselines3's class of the algorithm.
std::string_view ModelClassOf(const std::string& algorithm) {
  std::vector<std::string_view> known;
  for (const learner::Algorithm& candidate : learner::Algorithms()) {
    if (candidate.sb3.empty()) continue;
    if (candidate.name == algorithm) return candidate.sb3;
    known.push_back(candidate.name);
  }
  throw UsageError("learner.algorithm = {} has no counterpart in Stable-Baselines3: expected {}",
                   algorithm, fmt::join(known, " | "));
}

void RefuseWithoutCounterpart(const policy::PolicyDescription& policy, const nn::ActorPlan& actor) {
  const NetworkConfig& network = policy.network;
  const auto refuse = [](const std::string& what, const char* expected) {
    throw UsageError("{} has no counterpart in Stable-Baselines3: expected {}", what, expected);
  };
  if (network.blocks > 0) refuse(fmt::format("network.blocks = {}", network.blocks), "0");
  if (network.layer_norm) refuse("network.layer_norm = true", "false");
  if (!policy.spec.HasPixels()) return;
  if (network.encoder != "nature") refuse("network.encoder = " + network.encoder, "nature");
  if (actor.trunk.layers()[0].layer_norm) {
    refuse("network.trunk = " + network.trunk, "relu");
  }
  if (actor.vector_columns > 0) {
    refuse(fmt::format("an observation of pixels beside a vector of {}", actor.vector_columns),
           "pixels or vectors alone");
  }
}

// Copies parameters under Stable-Baselines3's names.
class Renamer {
 public:
  Renamer(nn::ParameterSet* set, nn::TensorMap* result) : set_(*set), result_(*result) {}

  // Copies a layer's weight and bias, or `rows` of their rows from `first_row` on, if `rows` is
  // given.
  void Layer(const std::string& ours, const std::string& theirs, int first_row = 0, int rows = 0) {
    for (const char* part : {".weight", ".bias"}) {
      Tensor(ours + part, theirs + part, first_row, rows);
    }
  }

  void Tensor(const std::string& ours, const std::string& theirs, int first_row = 0, int rows = 0) {
    const nn::Parameter parameter = set_.Find(ours);
    nn::NamedTensor tensor{"F32", parameter.shape(), {}};
    if (rows > 0) tensor.shape[0] = rows;
    int64_t count = 1;
    for (const int64_t size : tensor.shape) count *= size;
    const int64_t row = count / tensor.shape[0];
    const auto* bytes = reinterpret_cast<const uint8_t*>(parameter.value() + first_row * row);
    tensor.data.assign(bytes, bytes + size_t(count) * sizeof(float));
    result_[theirs] = std::move(tensor);
  }

 private:
  nn::ParameterSet& set_;
  nn::TensorMap& result_;
};

std::string ModelOf(const policy::PolicyDescription& policy, const nn::ActorPlan& actor,
                    std::string_view model_class) {
  const NetworkConfig& network = policy.network;
  std::string arguments =
      fmt::format("net_arch=[{}], activation_fn=torch.nn.{}", fmt::join(network.hidden, ", "),
                  network.activation == "tanh"  ? "Tanh"
                  : network.activation == "elu" ? "ELU"
                                                : "ReLU");
  if (policy.spec.HasPixels()) {
    arguments +=
        fmt::format(", features_extractor_kwargs=dict(features_dim={})", actor.trunk_columns());
  }
  return fmt::format("{}(\"{}Policy\", env, policy_kwargs=dict({}))", model_class,
                     policy.spec.HasPixels() ? "Cnn" : "Mlp", arguments);
}

void AddExtractors(const nn::NetworkPlan& encoder, const nn::ActorPlan& actor,
                   const Sb3Names& names, Renamer* renamer) {
  for (const std::string& extractor : names.extractors) {
    for (size_t i = 1; i < encoder.layers().size(); ++i) {  // after the pixels
      renamer->Layer(encoder.layers()[i].name, fmt::format("{}.cnn.{}", extractor, 2 * (i - 1)));
    }
    renamer->Layer(actor.trunk.layers()[0].name, extractor + ".linear.0");
  }
}

void AddMlp(const nn::ActorPlan& actor, const Sb3Names& names, Renamer* renamer) {
  const std::vector<nn::LayerPlan>& layers = actor.mlps[0].layers();
  const auto numbered = [&](size_t i) { return names.mlp + std::to_string(2 * i); };
  for (size_t i = 0; i + 1 < layers.size(); ++i) renamer->Layer(layers[i].name, numbered(i));
  const std::string output =
      names.output_layer.empty() ? numbered(layers.size() - 1) : names.output_layer;
  renamer->Layer(layers.back().name, output, 0, actor.action_size);
}

// Adds the deviations, the second half of a Gaussian's outputs.
void AddDeviation(const nn::ActorPlan& actor, Renamer* renamer, Sb3File* file) {
  if (actor.log_std == nn::LogStd::kClamped) {
    renamer->Layer(actor.mlps[0].layers().back().name, "actor.log_std", actor.action_size,
                   actor.action_size);
    return;
  }
  file->notes.emplace_back(
      "network.log_std = smooth has no counterpart: the model keeps its own deviation, and only "
      "predict(..., deterministic=True) is this policy");
}

}  // namespace

Sb3File WriteSb3(const policy::CheckpointPolicy& policy) {
  const policy::PolicyDescription& description = policy.description;
  const std::string_view model_class = ModelClassOf(description.algorithm);
  const Sb3Names& names = NamesOf(description.output);
  const nn::NetworkPlan encoder = description.Encoder();
  const nn::ActorPlan actor = description.Actor();
  RefuseWithoutCounterpart(description, actor);
  std::vector<nn::ParameterSpec> specs = encoder.Parameters();
  nn::Append(actor.Parameters(), &specs);
  nn::ParameterSet set(specs, nn::ParameterSet::Use::kInference);
  set.Import(policy.tensors, "", kPolicyFile, set.values());

  Sb3File file{.bytes = {}, .model = ModelOf(description, actor, model_class), .notes = {}};
  nn::TensorMap theirs;
  Renamer renamer(&set, &theirs);
  if (!actor.trunk.layers().empty()) AddExtractors(encoder, actor, names, &renamer);
  AddMlp(actor, names, &renamer);
  if (actor.output == ActorOutput::kUnsquashed) renamer.Tensor(actor.name + ".log_std", "log_std");
  if (actor.output == ActorOutput::kGaussian) AddDeviation(actor, &renamer, &file);
  std::vector<std::pair<std::string, std::string>> files{{"policy.pth", WriteTorchFile(theirs)}};
  if (nn::ReadVectorScale(policy.tensors, description.spec.VectorSize(), kPolicyFile)) {
    nn::TensorMap statistics;
    for (const char* name : {nn::kObservationMean, nn::kObservationVariance}) {
      statistics[name] = policy.tensors.at(name);
    }
    files.emplace_back("pytorch_variables.pth", WriteTorchFile(statistics));
    file.notes.emplace_back(
        "the policy normalises observations: wrap env in a VecNormalize with the mean and the "
        "variance of pytorch_variables.pth (docs/deploy.md)");
  }
  file.bytes = WriteZip(files);
  return file;
}

}  // namespace shoal::launch
