// SPDX-License-Identifier: Apache-2.0
// Checkpoints of small agents, written by the learner's code.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/base/random.h"
#include "common/config/batch_options.h"
#include "common/config/run_config.h"
#include "common/nn/parameter_set.h"
#include "learner/agent/algorithms.h"
#include "learner/checkpoint.h"
#include "learner/checkpoint_store.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::policy {

// A run whose observations have frames (with `pixels`), an observed block, an unobserved block, and
// another observed block.
inline RunConfig SmallRun(const std::string& algorithm, bool pixels) {
  RunConfig run{learner::SmallConfig(), learner::SmallSpec()};
  run.config.learner.algorithm = algorithm;
  run.config.learner.precision = "f32";
  run.config.learner.normalise_vectors = true;
  run.config.observation.pixels = pixels;
  run.config.observation.proprioception = true;
  run.spec.blocks = {{"grip", 3}, {"hidden", 4, /*observed=*/false}, {"goal", 2}};
  if (algorithm == "ppo") {
    run.config.learner.reward_scale = LearnerConfig().reward_scale;
    run.spec.drawn_actions = true;
  }
  if (algorithm == "mrq") {
    run.config.learner.normalise_vectors = false;
    run.config.learner.reward_scale = LearnerConfig().reward_scale;
    run.config.network.state_hidden = {10, 9};
  }
  if (!pixels) {
    run.spec.cameras.clear();
    run.spec.channels = run.spec.height = run.spec.width = 0;
    run.spec.stack = 1;
  }
  return run;
}

// SmallRun from pixels with another encoder. `side`: size of images that the encoder accepts.
inline RunConfig RunWithEncoder(const std::string& encoder, int side = 84) {
  RunConfig run = SmallRun("sac", /*pixels=*/true);
  run.config.network.encoder = encoder;
  run.config.network.filters.clear();
  run.config.network.strides.clear();
  run.config.network.initialisation = "pytorch";  // fast
  run.spec.height = run.spec.width = side;
  return run;
}

// Writes a checkpoint to FOLDER/checkpoints, like the learner. Returns the checkpoint's folder.
inline std::filesystem::path Store(const RunConfig& run, const std::filesystem::path& folder,
                                   uint64_t updates, const nn::TensorMap& learner,
                                   const nn::TensorMap& policy) {
  learner::CheckpointStore store(folder, run);
  CheckpointState state;
  state.updates = updates;
  state.config_hash = store.config_hash();
  state.spec_hash = run.spec.Hash();
  state.precision = "f32";
  state.algorithm = run.config.learner.algorithm;
  return folder / "checkpoints" / store.Write(state, learner, policy, {});
}

// Writes the checkpoint of an agent after three updates on random numbers.
inline std::filesystem::path WriteCheckpointOf(const RunConfig& run,
                                               const std::filesystem::path& folder) {
  const auto agent = learner::MakeAgent(run.config, run.spec, nn::Precision::kF32);
  const bool rollout = run.config.learner.algorithm == "ppo";
  const BatchOptions options{.batch = run.config.learner.batch * (rollout ? 2 : 1),
                             .horizon = BatchOptionsOf(run).horizon,
                             .rollout = rollout,
                             .privileged = BatchOptionsOf(run).privileged};
  for (uint64_t u = 0; u < 3; ++u) {
    const learner::RandomBatch batch(run.spec, options, u);
    EXPECT_TRUE(agent->Update(batch.View()).finite);
  }
  return Store(run, folder, agent->updates(), agent->AllTensors(), agent->AveragedPolicyTensors());
}

// Writes a checkpoint that contains only a policy with random parameters. For encoders whose
// optimiser states would be large.
inline std::filesystem::path WritePolicyOf(const RunConfig& run,
                                           const std::filesystem::path& folder) {
  nn::ParameterSet parameters(nn::PolicyParameters(run.config.network, run.spec),
                              nn::ParameterSet::Use::kInference);
  parameters.Initialise(3);
  nn::TensorMap policy;
  parameters.Export(&policy);
  return Store(run, folder, 0, {}, policy);
}

// `count` random observations of a spec.
struct RandomObservations {
  RandomObservations(const ObservationSpec& spec, int number, uint64_t key)
      : count(number),
        pixels(size_t(number) * size_t(spec.FrameBytes()) * size_t(spec.stack)),
        vectors(size_t(number) * size_t(spec.VectorSize())) {
    Random random(key);
    for (uint8_t& pixel : pixels) pixel = uint8_t(random.Next());
    for (float& value : vectors) value = float(random.Normal());
    for (const BlockSpec& block : spec.blocks) {
      const auto range = spec.Observed(block.name);
      if (!range) continue;
      std::vector<float> values;
      for (int n = 0; n < count; ++n) {
        const auto first = vectors.begin() + n * spec.VectorSize() + range->first;
        values.insert(values.end(), first, first + range->size);
      }
      blocks.emplace_back(block.name, std::move(values));
    }
  }

  int count;
  std::vector<uint8_t> pixels;                                     // (N, K*C, H, W)
  std::vector<float> vectors;                                      // (N, V)
  std::vector<std::pair<std::string, std::vector<float>>> blocks;  // `vectors`, block by block
};

}  // namespace shoal::policy
