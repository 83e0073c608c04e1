// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/mrq/reward_scales.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/nn/tensor_words.h"

namespace shoal::learner {
namespace {

constexpr char kTensor[] = "critic.scales";
constexpr double kLeast = 1e-8;

}  // namespace

void RewardScales::Add(const BatchView& batch) {
  for (const float reward : batch.steps.front().reward) sum_ += std::abs(double{reward});
  count_ += double(batch.rows());
}

void RewardScales::Advance() {
  target_ = critic_;
  if (sum_ > 0) critic_ = std::max(kLeast, sum_ / count_);
  sum_ = count_ = 0;
}

void RewardScales::Export(nn::TensorMap* tensors) const {
  std::vector<uint64_t> words;
  for (const double number : {critic_, target_, sum_, count_}) {
    words.push_back(std::bit_cast<uint64_t>(number));
  }
  (*tensors)[kTensor] = nn::WordsTensor(words);
}

void RewardScales::Import(const nn::TensorMap& tensors, const std::string& source) {
  const auto words = nn::ReadWords(tensors, kTensor, 4, source);
  const std::array numbers{&critic_, &target_, &sum_, &count_};
  for (size_t i = 0; i < numbers.size(); ++i) *numbers[i] = std::bit_cast<double>(words[i]);
}

}  // namespace shoal::learner
