// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/running_moments.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "common/nn/tensor_words.h"

namespace shoal::learner {

void ExportMoments(std::span<const double> moments, const std::string& name,
                   nn::TensorMap* tensors) {
  std::vector<uint64_t> words(moments.size());
  std::ranges::transform(moments, words.begin(),
                         [](double x) { return std::bit_cast<uint64_t>(x); });
  (*tensors)[name] = nn::WordsTensor(words);
}

std::vector<double> ImportMoments(size_t width, const std::string& name,
                                  const nn::TensorMap& tensors, const std::string& source) {
  const std::vector<uint64_t> words = nn::ReadWords(tensors, name, MomentsSize(width), source);
  std::vector<double> moments(words.size());
  std::ranges::transform(words, moments.begin(),
                         [](uint64_t x) { return std::bit_cast<double>(x); });
  return moments;
}

}  // namespace shoal::learner
