// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/running_moments.h"

#include <algorithm>
#include <bit>

#include "common/base/check.h"
#include "common/nn/tensor_words.h"

namespace shoal::learner {

RunningMoments::RunningMoments(int size) : mean_(size_t(size)), squares_(size_t(size)) {}

void RunningMoments::Add(std::span<const float> rows) {
  const size_t width = mean_.size();
  if (width == 0) return;
  CHECK(rows.size() % width == 0) << rows.size();
  const size_t n = rows.size() / width;
  if (n == 0) return;
  const auto added = double(n);
  for (size_t j = 0; j < width; ++j) {
    double mean = 0, squares = 0;
    for (size_t i = 0; i < n; ++i) mean += double{rows[i * width + j]} / added;
    for (size_t i = 0; i < n; ++i) {
      const double distance = double{rows[i * width + j]} - mean;
      squares += distance * distance;
    }
    const double apart = mean - mean_[j], total = count_ + added;
    squares_[j] += squares + apart * apart * count_ * added / total;
    mean_[j] += apart * added / total;
  }
  count_ += added;
}

std::vector<float> RunningMoments::Mean() const { return {mean_.begin(), mean_.end()}; }

std::vector<float> RunningMoments::Variance() const {
  std::vector<float> variance(squares_.size(), 1.f);
  if (count_ == 0) return variance;
  std::ranges::transform(squares_, variance.begin(), [&](double s) { return float(s / count_); });
  return variance;
}

void RunningMoments::Export(const std::string& name, nn::TensorMap* tensors) const {
  std::vector<uint64_t> words{std::bit_cast<uint64_t>(count_)};
  for (const double x : mean_) words.push_back(std::bit_cast<uint64_t>(x));
  for (const double x : squares_) words.push_back(std::bit_cast<uint64_t>(x));
  (*tensors)[name] = nn::WordsTensor(words);
}

void RunningMoments::Import(const nn::TensorMap& tensors, const std::string& name,
                            const std::string& source) {
  const std::vector<uint64_t> words = nn::ReadWords(tensors, name, 1 + 2 * mean_.size(), source);
  count_ = std::bit_cast<double>(words[0]);
  for (size_t j = 0; j < mean_.size(); ++j) {
    mean_[j] = std::bit_cast<double>(words[1 + j]);
    squares_[j] = std::bit_cast<double>(words[1 + mean_.size() + j]);
  }
}

}  // namespace shoal::learner
