// SPDX-License-Identifier: Apache-2.0
// One action of a trained policy outside of training, as libshoal-policy computes it: the cost of
// checks and of blocks by name, compared with the network itself.
#include <fmt/core.h>

#include "common/nn/parameter_set.h"
#include "common/policy/trained_policy.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

struct Acting {
  explicit Acting(const policy::CheckpointPolicy& checkpoint)
      : trained(checkpoint),
        network(checkpoint.description.network, checkpoint.description.spec, nn::Precision::kF32,
                1),
        pixels(size_t(trained.spec().FrameBytes()) * size_t(trained.spec().stack), 100),
        vector(size_t(trained.spec().VectorSize()), 0.5f),
        action(size_t(trained.spec().action_size)) {
    network.Load(checkpoint.tensors, "benchmark");
    for (const BlockSpec& block : trained.spec().blocks) {
      const auto [first, size] = *trained.spec().Observed(block.name);
      blocks.push_back({block.name, std::span(vector).subspan(size_t(first), size_t(size))});
    }
  }

  policy::TrainedPolicy trained;
  nn::Policy network;
  std::vector<uint8_t> pixels;
  std::vector<float> vector, action;
  std::vector<policy::ObservedBlock> blocks;
};

// Acting with initial parameters.
std::shared_ptr<Acting> MakeActing(const NetworkConfig& network, const ObservationSpec& spec) {
  policy::CheckpointPolicy checkpoint;
  checkpoint.description.network = network;
  checkpoint.description.spec = spec;
  nn::ParameterSet parameters(nn::PolicyParameters(network, spec),
                              nn::ParameterSet::Use::kInference);
  parameters.Initialise(1);
  parameters.Export(&checkpoint.tensors);
  return std::make_shared<Acting>(checkpoint);
}

// FetchReach from state.
ObservationSpec StateSpec() {
  ObservationSpec spec;
  spec.blocks = {{"grip", 3}, {"fingers", 2}, {"velocity", 5}, {"desired_goal", 3}};
  spec.action_size = 4;
  return spec;
}

ObservationSpec PictureSpec(int stack, int channels) {
  ObservationSpec spec;
  spec.stack = stack;
  spec.channels = channels;
  spec.height = spec.width = 84;
  spec.action_size = 4;
  return spec;
}

Pairing ActionRow(const std::string& what, const std::string& encoder,
                  const ObservationSpec& spec) {
  NetworkConfig network;
  network.encoder = encoder;
  const auto acting = MakeActing(network, spec);
  return {
      .stage = fmt::format("one action of a trained policy, {}", what),
      .unit = "actions/s",
      .against = "its network alone",
      .ours =
          [acting] {
            acting->trained.Act({1, acting->pixels, acting->blocks}, acting->action);
          },
      .other =
          [acting] { acting->network.Forward(1, acting->pixels.data(), acting->vector.data()); }};
}

}  // namespace

std::vector<Pairing> PolicyPairings() {
  return {ActionRow("state of 13 numbers", "compact", StateSpec()),
          ActionRow("compact, (6, 84, 84)", "compact", PictureSpec(1, 6)),
          ActionRow("nature, (4, 84, 84)", "nature", PictureSpec(4, 1))};
}

}  // namespace shoal::bench
