// SPDX-License-Identifier: Apache-2.0
// Updates of Stable-Baselines3 or PyTorch, and an agent that starts from the same weights.
// tests/comparison/sb3_updates.py and drqv2_updates.py recorded the updates and describe the files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/shared_numbers.h"

namespace shoal::learner {

// Fills `batch` with the recorded batch of an update.
inline void FillSb3Batch(int update, const BatchView& batch) {
  const std::string at = "update" + std::to_string(update) + ".";
  FillSymmetric(at + "obs", 1.5, batch.obs_vector);
  FillBytes(at + "pixels", batch.obs_frames);
  FillSymmetric(at + "action", 1.0, batch.action);
  FillSymmetric(at + "next_obs", 1.5, batch.next_obs_vector);
  FillBytes(at + "next_pixels", batch.next_obs_frames);
  FillSymmetric(at + "reward", 2.0, batch.reward);
  std::ranges::fill(batch.bootstrap, 1.f);
  const auto end = [&](int i) { batch.bootstrap[size_t(i) % batch.bootstrap.size()] = 0; };
  end(update);
  end(update + 3);
}

class Sb3Recording {
 public:
  static constexpr int kUpdates = 4;

  // `name`: a file of tests/golden, without ".safetensors".
  explicit Sb3Recording(const std::string& name)
      : recorded_(nn::ReadSafetensors(ReadFile(GoldenPath(name + ".safetensors")), name)) {}

  // Maps a recorded layer to a layer of Shoal, or to part number `part` of `parts`
  // equal parts of Shoal's layer. The names are without ".weight" and ".bias". `scale`: factor of
  // the weights.
  void Add(const std::string& ours, const std::string& theirs, int part = 0, int parts = 1,
           double scale = 1) {
    layers_.push_back({ours, theirs, part, parts, scale});
  }
  // Adds an MLP of two hidden layers.
  void AddMlp(const std::string& ours, const std::string& theirs) {
    Add(ours + ".layer0", theirs + ".0");
    Add(ours + ".layer1", theirs + ".2");
    Add(ours + ".output", theirs + ".4");
  }

  // Returns the agent's `tensors` with the initial weights of the recording.
  nn::TensorMap WithTheirWeights(nn::TensorMap tensors) const {
    for (const Layer& layer : layers_) {
      const std::vector<int64_t> shape = tensors.at(layer.ours + ".weight").shape;
      double fan_in = 1;
      for (size_t i = 1; i < shape.size(); ++i) fan_in *= double(shape[i]);
      for (const char* kind : kKinds) {
        nn::NamedTensor& tensor = tensors.at(layer.ours + kind);
        std::vector<float> numbers = Floats(tensors, layer.ours + kind);
        FillSymmetric(layer.theirs + kind,
                      layer.scale * std::sqrt((std::string(kind) == ".weight" ? 6 : 1) / fan_in),
                      Part(layer, numbers));
        std::memcpy(tensor.data.data(), numbers.data(), tensor.data.size());
      }
    }
    return tensors;
  }

  bool Has(int update, const std::string& name) const {
    return recorded_.contains(std::to_string(update) + "." + name);
  }
  std::vector<float> Get(int update, const std::string& name) const {
    return Floats(recorded_, std::to_string(update) + "." + name);
  }

  double Mean(int update, const std::string& name) const {
    const std::vector<float> numbers = Get(update, name);
    return std::accumulate(numbers.begin(), numbers.end(), 0.0) / double(numbers.size());
  }

  // Compares every parameter and target after the update.
  void ExpectParameters(int update, const nn::TensorMap& after) const {
    for (const Layer& layer : layers_) {
      for (const char* kind : kKinds) {
        std::vector<float> numbers = Floats(after, layer.ours + kind);
        const auto ours = Thin(Part(layer, numbers));
        const auto theirs = Get(update, "after." + layer.theirs + kind);
        ASSERT_EQ(ours.size(), theirs.size()) << layer.ours << kind;
        for (size_t i = 0; i < ours.size(); ++i) {
          ASSERT_NEAR(ours[i], theirs[i], 5e-6) << layer.ours << kind << " " << i;
        }
      }
    }
  }

  // Compares the gradients g, computed from Adam's first moments before (m) and after (m') the
  // update: m' = 0.9 m + 0.1 g. `factor`: Shoal's loss divided by the recorded loss, by layer.
  // Returns the number of compared tensors.
  template <class Factor>
  int ExpectGradients(int update, const nn::TensorMap& before, const nn::TensorMap& after,
                      Factor factor) const {
    int compared = 0;
    for (const Layer& layer : layers_) {
      for (const char* kind : kKinds) {
        if (!Has(update, "gradient." + layer.theirs + kind)) continue;
        ExpectGradient(update, layer, kind, before, after, factor(layer.theirs));
        ++compared;
      }
    }
    return compared;
  }

 private:
  static constexpr const char* kKinds[] = {".weight", ".bias"};
  static constexpr double kFirstMoment = 0.1;  // 1 - b1 of Adam

  struct Layer {
    std::string ours, theirs;
    int part, parts;
    double scale;
  };

  static std::span<float> Part(const Layer& layer, std::vector<float>& numbers) {
    const size_t size = numbers.size() / size_t(layer.parts);
    return std::span(numbers).subspan(size_t(layer.part) * size, size);
  }
  // The subset of numbers that a recording keeps.
  static std::vector<float> Thin(std::span<const float> numbers) {
    const size_t step = numbers.size() > 1024 ? (numbers.size() + 255) / 256 : 1;
    std::vector<float> kept;
    for (size_t i = 0; i < numbers.size(); i += step) kept.push_back(numbers[i]);
    return kept;
  }

  void ExpectGradient(int update, const Layer& layer, const std::string& kind,
                      const nn::TensorMap& before, const nn::TensorMap& after,
                      double factor) const {
    const auto theirs = Get(update, "gradient." + layer.theirs + kind);
    const std::string moment = "adam.m." + layer.ours + kind;
    std::vector<float> all_before = Floats(before, moment), all_after = Floats(after, moment);
    const auto m = Thin(Part(layer, all_before)), next = Thin(Part(layer, all_after));
    ASSERT_EQ(m.size(), theirs.size()) << moment;
    const float largest =
        std::abs(*std::ranges::max_element(theirs, {}, [](float g) { return std::abs(g); }));
    ASSERT_GT(largest, 0) << layer.theirs;
    for (size_t i = 0; i < theirs.size(); ++i) {
      const double ours = (next[i] - (1 - kFirstMoment) * m[i]) / kFirstMoment / factor;
      ASSERT_NEAR(ours, theirs[i], 1e-4 * largest) << layer.ours << kind << " " << i;
    }
  }

  const nn::TensorMap recorded_;
  std::vector<Layer> layers_;
};

}  // namespace shoal::learner
