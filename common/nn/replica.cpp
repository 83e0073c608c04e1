#include "common/nn/replica.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int64_t kSumBlock = 1024;  // floats summed at a time: they stay in the first-level cache
constexpr int64_t kCacheLine = 16;   // floats

SHOAL_CPU_CLONES void AddTo(const float* values, int64_t n, float* sum) {
  for (int64_t i = 0; i < n; ++i) sum[i] += values[i];
}

SHOAL_CPU_CLONES void Scale(float factor, int64_t n, float* values) {
  for (int64_t i = 0; i < n; ++i) values[i] *= factor;
}

// Each array's floats [begin, end) become their mean.
void AverageRange(std::span<float* const> arrays, int64_t begin, int64_t end) {
  float sum[kSumBlock];
  for (int64_t at = begin; at < end; at += kSumBlock) {
    const int64_t n = std::min(kSumBlock, end - at);
    std::copy_n(arrays[0] + at, n, sum);
    for (const float* array : arrays.subspan(1)) AddTo(array + at, n, sum);
    Scale(1.f / float(arrays.size()), n, sum);
    for (float* array : arrays) std::copy_n(sum, n, array + at);
  }
}

}  // namespace

Replica::Replica(Exchange* exchange, int rank)
    : exchange_(exchange), rank_(rank), count_(int(exchange->offers_[0].size())) {
  CHECK(rank >= 0 && rank < count_) << rank << " of " << count_;
}

int Replica::threads() const { return exchange_ == nullptr ? Threads() : 1; }

int Replica::Rows(int batch) const {
  CHECK(batch % count_ == 0) << "batch of " << batch << " for " << count_ << " replicas";
  return batch / count_;
}

std::span<const Exchange::Offer> Replica::Show(Exchange::Offer offer) {
  std::vector<Exchange::Offer>& offers = exchange_->offers_[turn_++ % 2];
  offers[size_t(rank_)] = std::move(offer);
  exchange_->barrier_.ArriveAndWait();
  return offers;
}

// Every replica averages a range of its own, in the arrays of all.
void Replica::AverageGradients(std::span<ParameterSet* const> sets) {
  if (count_ == 1) return;
  const auto offers = Show({.sets = sets, .arrays = {}, .numbers = {}});
  std::vector<float*> arrays(offers.size());
  for (size_t s = 0; s < sets.size(); ++s) {
    const int64_t lines = sets[s]->trained_size() / kCacheLine;
    for (size_t r = 0; r < arrays.size(); ++r) arrays[r] = offers[r].sets[s]->gradients();
    AverageRange(arrays, lines * rank_ / count_ * kCacheLine,
                 lines * (rank_ + 1) / count_ * kCacheLine);
  }
  exchange_->barrier_.ArriveAndWait();
}

std::vector<std::vector<float>> Replica::Whole(std::span<const std::span<const float>> own) {
  std::vector<std::vector<float>> whole;
  for (const std::span<const float> values : own) whole.emplace_back(values.begin(), values.end());
  if (count_ == 1) return whole;
  const auto offers = Show({.sets = {}, .arrays = whole, .numbers = {}});
  for (size_t i = 0; i < whole.size(); ++i) {
    whole[i].clear();
    for (const Exchange::Offer& offer : offers) {
      whole[i].insert(whole[i].end(), offer.arrays[i].begin(), offer.arrays[i].end());
    }
  }
  return whole;
}

std::vector<double> Replica::Means(std::initializer_list<double> own) {
  std::vector<double> means(own);
  if (count_ == 1) return means;
  const auto offers = Show({.sets = {}, .arrays = {}, .numbers = means});
  std::ranges::fill(means, 0.0);
  for (const Exchange::Offer& offer : offers) {
    for (size_t i = 0; i < means.size(); ++i) means[i] += offer.numbers[i] / count_;
  }
  return means;
}

std::vector<double> Replica::Normals(int rows, int per_row, Random* random) const {
  const size_t own = size_t(rows) * size_t(per_row);
  std::vector<double> all(own * size_t(count_));
  for (double& value : all) value = random->Normal();
  const auto first = all.begin() + std::ptrdiff_t(own) * rank_;
  return {first, first + std::ptrdiff_t(own)};
}

}  // namespace shoal::nn
