#include "common/nn/policy.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>

#include "common/base/check.h"
#include "common/nn/actor_head.h"
#include "common/nn/encoder.h"
#include "common/nn/parallel.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {
namespace {

std::vector<ParameterShape> PolicyParameters(const NetworkConfig& network,
                                             const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes = EncoderParameters(network, spec);
  for (ParameterShape& shape : ActorParameters(network, spec)) shapes.push_back(std::move(shape));
  return shapes;
}

// Encoder and actor built for one batch size.
struct SizedNetwork {
  SizedNetwork(const LayerContext& context, const NetworkConfig& network,
               const ObservationSpec& spec) {
    if (spec.HasPixels()) encoder.emplace(context, network, spec);
    actor.emplace(context, network, spec, encoder ? encoder->features() : dnnl::memory());
    Refresh();
  }

  void Refresh() {
    if (encoder) encoder->Refresh();
    actor->Refresh();
  }

  std::optional<Encoder> encoder;
  std::optional<ActorHead> actor;
};

}  // namespace

struct Policy::Impl {
  Impl(const NetworkConfig& network_config, const ObservationSpec& observation_spec,
       Precision compute_precision, int largest_batch)
      : network(network_config),
        spec(observation_spec),
        precision(compute_precision),
        max_batch(largest_batch),
        threads(Threads()),
        parameters(PolicyParameters(network, spec), ParameterSet::Use::kInference),
        scratchpad(std::make_shared<Scratchpad>()) {}

  // Built when a batch size is first seen, kept for good: an actor uses one or two.
  SizedNetwork& ForBatch(int batch) {
    const auto found = networks.find(batch);
    if (found != networks.end()) return found->second;
    const LayerContext context{&parameters, precision, batch, /*training=*/false, scratchpad};
    return networks.try_emplace(batch, context, network, spec).first->second;
  }

  const NetworkConfig network;
  const ObservationSpec spec;
  const Precision precision;
  const int max_batch;
  const int threads;
  ParameterSet parameters;
  std::shared_ptr<Scratchpad> scratchpad;
  std::map<int, SizedNetwork> networks;
};

Policy::Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
               int max_batch)
    : impl_(std::make_unique<Impl>(network, spec, precision, max_batch)) {
  const ThreadScope scope(impl_->threads);
  impl_->ForBatch(max_batch);
}

Policy::~Policy() = default;

void Policy::Load(const TensorMap& tensors, const std::string& source) {
  const ThreadScope scope(impl_->threads);
  ParameterSet& parameters = impl_->parameters;
  std::vector<float> values(size_t(parameters.size()), 0.f);
  parameters.Import(tensors, "", source, values.data());
  std::copy(values.begin(), values.end(), parameters.values());
  for (auto& [batch, network] : impl_->networks) network.Refresh();
}

void Policy::Forward(int batch, const uint8_t* frames, const float* vector, float* mean,
                     float* log_std) {
  CHECK(batch > 0 && batch <= impl_->max_batch) << batch << " of at most " << impl_->max_batch;
  const ThreadScope scope(impl_->threads);
  SizedNetwork& network = impl_->ForBatch(batch);
  if (network.encoder) network.encoder->Forward(frames);
  network.actor->Forward(vector);
  const size_t bytes = size_t(batch) * size_t(impl_->spec.action_size) * sizeof(float);
  std::memcpy(mean, network.actor->mean(), bytes);
  std::memcpy(log_std, network.actor->log_std(), bytes);
}

}  // namespace shoal::nn
