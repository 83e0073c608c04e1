// SPDX-License-Identifier: Apache-2.0
// A small agent and batches for it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/aligned_bytes.h"
#include "common/base/random.h"
#include "common/nn/policy.h"
#include "common/nn/precision.h"
#include "learner/agent/algorithms.h"

namespace shoal::learner {

// A batch that owns its memory, filled with random values. A rollout has one environment.
class RandomBatch {
 public:
  RandomBatch(const ObservationSpec& spec, int batch, uint64_t key, bool rollout = false)
      : RandomBatch(spec, BatchOptions{.batch = batch, .rollout = rollout}, key) {}
  RandomBatch(const ObservationSpec& spec, const BatchOptions& options, uint64_t key)
      : schema_(spec, options), memory_(schema_.total_bytes()) {
    std::memset(memory_.data(), 0, schema_.total_bytes());
    Random random(key);
    const BatchView view = View();
    for (uint8_t& pixel : view.obs_frames) pixel = uint8_t(random.Next());
    for (uint8_t& pixel : view.next_obs_frames) pixel = uint8_t(random.Next());
    for (float& value : view.obs_vector) value = float(random.Normal());
    for (float& value : view.next_obs_vector) value = float(random.Normal());
    for (float& value : view.action) value = float(random.Uniform(-1, 1));
    for (float& value : view.reward) value = float(random.Normal());
    for (float& value : view.bootstrap) value = random.Uniform() < 0.8 ? 1.f : 0.f;
    for (float& value : view.drawn_action) value = float(random.Normal());
    for (float& value : view.obs_privileged) value = float(random.Normal());
    for (float& value : view.next_obs_privileged) value = float(random.Normal());
    for (float& value : view.log_prob) value = -2.5f + 0.2f * float(random.Normal());
    for (size_t t = 0; t < view.continues.size(); ++t) {
      view.ends[t] = 1 - view.bootstrap[t];
      view.continues[t] = t + 1 < view.continues.size() ? view.bootstrap[t] : 0;
    }
    for (float& value : view.probability) value = float(random.Uniform(0.001, 0.1));
    FillSteps(view, &random);
  }

  BatchView View() const { return schema_.View(memory_.data()); }

 private:
  // A step ends its sequence with probability 0.2.
  static void FillSteps(const BatchView& view, Random* random) {
    for (size_t h = 0; h < view.steps.size(); ++h) {
      const StepView& step = view.steps[h];
      for (uint8_t& pixel : step.next_frames) pixel = uint8_t(random->Next());
      for (float& value : step.next_vector) value = float(random->Normal());
      for (float& value : step.action) value = float(random->Uniform(-1, 1));
      for (float& value : step.reward) value = float(random->Normal());
      for (size_t b = 0; b < view.rows(); ++b) {
        const StepView* before = h == 0 ? nullptr : &view.steps[h - 1];
        step.present[b] = before == nullptr ? 1 : before->present[b] * (1 - before->terminated[b]);
        step.terminated[b] = random->Uniform() < 0.2 ? step.present[b] : 0;
      }
    }
  }

  BatchSchema schema_;
  AlignedBytes memory_;
};

// Spec with 18x16 grey frames in stacks of 2, a vector of 2 numbers and 2 actions.
inline ObservationSpec SmallSpec() {
  ObservationSpec spec;
  spec.task = "test";
  spec.cameras = {"front"};
  spec.channels = 1;
  spec.height = 18;
  spec.width = 16;
  spec.stack = 2;
  spec.blocks = {{"goal", 2}};
  spec.action_size = 2;
  return spec;
}

inline Config SmallConfig() {
  Config config;
  config.seed = 7;
  config.learner.batch = 6;
  config.learner.reward_scale = 2;
  config.network.filters = {4, 6};
  config.network.strides = {1, 2};
  config.network.features = 9;
  config.network.hidden = {12, 11};
  return config;
}

// The value of `figure` in the outcome. If the update did not compute the value, NaN, which never
// compares equal.
inline double Get(const UpdateOutcome& outcome, const Figure& figure) {
  return outcome.figures.Get(figure).value_or(std::nan(""));
}

inline std::vector<float> Floats(const nn::TensorMap& tensors, const std::string& name) {
  const nn::NamedTensor& tensor = tensors.at(name);
  std::vector<float> values(tensor.data.size() / sizeof(float));
  std::memcpy(values.data(), tensor.data.data(), tensor.data.size());
  return values;
}

// Mean error of an agent's policy after 400 updates on a bandit with reward -(a - s0 / 2)^2, where
// every step is terminal and the best action is s0 / 2. `make` replaces MakeAgent. For comparison:
// a policy that ignores the state has a mean error of 0.25, uniform actions have 0.56.
template <class Make>
float BanditError(Config config, Make make) {
  ObservationSpec spec;
  spec.task = "bandit";
  spec.blocks = {{"state", 2}};
  spec.action_size = 1;
  config.learner.batch = 64;
  config.learner.learning_rate = 3e-3;
  config.learner.reward_scale = 5;
  config.network.hidden = {32, 32};
  const std::unique_ptr<Agent> agent = make(config, spec, nn::Precision::kF32);
  Random random(1);
  for (uint64_t u = 0; u < 400; ++u) {
    const RandomBatch batch(spec, config.learner.batch, u);
    const BatchView view = batch.View();
    for (size_t b = 0; b < view.reward.size(); ++b) {
      view.obs_vector[2 * b] = float(random.Uniform(-1, 1));
      const float error = view.action[b] - view.obs_vector[2 * b] / 2;
      view.reward[b] = -error * error;
      view.bootstrap[b] = 0;
    }
    EXPECT_TRUE(agent->Update(view).finite);
  }
  nn::Policy policy(config.network, spec, nn::Precision::kF32, 1);
  policy.Load(agent->PolicyTensors(), "agent");
  float error = 0;
  for (int i = 0; i < 41; ++i) {
    const float state[2] = {float(i - 20) / 20, 0.f};
    error += std::abs(std::tanh(policy.Forward(1, nullptr, state).mean[0]) - state[0] / 2) / 41;
  }
  return error;
}

// Adds noise to every value of the F32 tensors whose names start with `prefix`, so that target
// networks differ from the online networks as after many updates.
inline nn::TensorMap Perturbed(nn::TensorMap tensors, const std::string& prefix) {
  Random random(11);
  for (auto& [name, tensor] : tensors) {
    if (!name.starts_with(prefix)) continue;
    std::vector<float> values = Floats(tensors, name);
    for (float& value : values) value += 0.2f * float(random.Normal());
    std::memcpy(tensor.data.data(), values.data(), tensor.data.size());
  }
  return tensors;
}

// Names of the tensors whose names start with `prefix` and whose values differ.
inline std::vector<std::string> Differences(const nn::TensorMap& a, const nn::TensorMap& b,
                                            const std::string& prefix = "") {
  std::vector<std::string> names;
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [name, tensor] : a) {
    if (name.starts_with(prefix) && tensor.data != b.at(name).data) names.push_back(name);
  }
  return names;
}

}  // namespace shoal::learner
