// SPDX-License-Identifier: Apache-2.0
#include "common/nn/replica.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int64_t kUnit = 16;  // floats: a parameter begins at a multiple of it

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

Replica::Share Replica::ShareOf(int64_t floats) const {
  if (count_ == 1) return {0, floats};
  CHECK(floats % kUnit == 0) << floats;
  const int64_t units = floats / kUnit;
  return {units * rank_ / count_ * kUnit, units * (rank_ + 1) / count_ * kUnit};
}

std::vector<void*> Replica::Objects(void* own) {
  if (count_ == 1) return {own};
  std::vector<void*> objects;
  for (const Exchange::Offer& offer : Show({.object = own, .arrays = {}, .numbers = {}})) {
    objects.push_back(offer.object);
  }
  return objects;
}

void Replica::Meet() {
  if (count_ > 1) exchange_->barrier_.ArriveAndWait();
}

std::vector<std::vector<float>> Replica::Whole(std::span<const std::span<const float>> own) {
  std::vector<std::vector<float>> whole;
  for (const std::span<const float> values : own) whole.emplace_back(values.begin(), values.end());
  if (count_ == 1) return whole;
  const auto offers = Show({.object = nullptr, .arrays = whole, .numbers = {}});
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
  const auto offers = Show({.object = nullptr, .arrays = {}, .numbers = means});
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
