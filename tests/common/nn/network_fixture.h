// SPDX-License-Identifier: Apache-2.0
// A small network with odd sizes, random parameters and inputs, and its copy in double precision.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/encoder.h"
#include "tests/common/nn/layer_fixture.h"
#include "tests/common/nn/reference_network.h"

namespace shoal::nn {

inline NetworkConfig OddNetwork() {
  NetworkConfig network;
  network.filters = {5, 7};
  network.strides = {2, 1};
  network.features = 11;
  network.hidden = {13, 9};
  return network;
}

// Spec with pixels (2*3, 22, 18), a vector of 5 numbers and 3 actions; without `pixels`, the vector
// and the actions alone.
inline ObservationSpec OddSpec(bool pixels) {
  ObservationSpec spec;
  spec.task = "test";
  if (pixels) {
    spec.cameras = {"front"};
    spec.channels = 3;
    spec.height = 22;
    spec.width = 18;
    spec.stack = 2;
  }
  spec.blocks = {{"goal", 2}, {"joints", 3}};
  spec.action_size = 3;
  return spec;
}

inline std::vector<uint8_t> RandomFrames(const ObservationSpec& spec, int batch, uint64_t key) {
  Random random(key);
  std::vector<uint8_t> frames(size_t(batch * spec.stack * spec.FrameBytes()));
  for (uint8_t& pixel : frames) pixel = uint8_t(random.Next());
  return frames;
}

inline std::vector<ParameterSpec> AllParameters(const NetworkConfig& network,
                                                const ObservationSpec& spec) {
  std::vector<ParameterSpec> parameters = PolicyParameters(network, spec);
  Append(PlanCritic(network, spec, "critic").Parameters(), &parameters);
  return parameters;
}

class NetworkTest : public LayerTest {
 protected:
  static constexpr int kBatch = 5;

  void Build(bool pixels, const NetworkConfig& network = OddNetwork()) {
    Build(OddSpec(pixels), network);
  }

  // Builds the parameters and, if there are pixels, computes the encoder's features.
  void Build(const ObservationSpec& spec, const NetworkConfig& network) {
    network_ = network;
    spec_ = spec;
    encoder_.reset();  // the encoder borrows the previous parameters
    parameters_ = std::make_unique<ParameterSet>(AllParameters(network_, spec_),
                                                 ParameterSet::Use::kTraining);
    // The parameters are initialised, then changed so that biases and norms have no special values.
    parameters_->Initialise(1);
    Random random(2);
    for (int64_t i = 0; i < parameters_->size(); ++i) {
      parameters_->values()[i] += float(0.1 * random.Normal());
    }
    TensorMap tensors;
    parameters_->Export(parameters_->values(), "", &tensors);
    reference_ = std::make_unique<reference::Network>(tensors, network_, spec_);
    vector_ = RandomValues(kBatch * 5, 3);
    action_ = RandomValues(kBatch * 3, 4);
    if (!spec.HasPixels()) return;
    frames_ = RandomFrames(spec_, kBatch, 5);
    encoder_ =
        std::make_unique<Encoder>(Context(*parameters_, kBatch), PlanEncoder(network_, spec_));
    encoder_->Refresh();
    encoder_->Forward(frames_.data(), Statistics::kBatch);
    // The heads get the same features as the reference, so that a test measures only its own layer.
    features_ = ToDoubles(ReadMemory(encoder_->features()));
  }

  dnnl::memory features() const { return encoder_ ? encoder_->features() : dnnl::memory(); }

  // Compares gradients of some elements of each parameter below `prefix` with central differences
  // of `loss`, evaluated on reference_.
  void ExpectGradients(const std::string& prefix, const std::function<double()>& loss) {
    for (const auto& [name, values] : reference_->parameters()) {
      if (!name.starts_with(prefix)) continue;
      const std::span<const float> gradient = GradientOf(*parameters_, name);
      std::vector<float> some;
      reference::Values exact;
      for (size_t i = 0; i < values.size(); i += 1 + values.size() / 12) {
        some.push_back(gradient[i]);
        exact.push_back(CentralDifference(&reference_->at(name, i), loss));
      }
      EXPECT_LT(RelativeError(some, exact), GradientTolerance()) << name;
    }
  }

  // A gradient passes through more layers than an output. In bf16, the input of a ReLU near 0 may
  // also have another sign than in double.
  double GradientTolerance() const { return GetParam() == Precision::kF32 ? 2e-4 : 0.15; }

  NetworkConfig network_;
  ObservationSpec spec_;
  std::unique_ptr<ParameterSet> parameters_;
  std::unique_ptr<reference::Network> reference_;
  std::unique_ptr<Encoder> encoder_;
  std::vector<uint8_t> frames_;
  reference::Values vector_, action_, features_;
};

}  // namespace shoal::nn
