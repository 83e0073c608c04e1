// SPDX-License-Identifier: Apache-2.0
#include "common/nn/replica.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int64_t kUnit = 16;  // floats: a parameter begins at a multiple of it

// First row of each of N shares of whole groups, then the number of all rows.
std::vector<int> FirstRows(int replicas, int rows, int copies) {
  CHECK(replicas > 0 && copies > 0 && rows % copies == 0) << rows << " rows of " << copies;
  const int64_t groups = rows / copies;
  CHECK(groups >= replicas) << groups << " groups of rows for " << replicas << " replicas";
  std::vector<int> first;
  for (int64_t r = 0; r <= replicas; ++r) first.push_back(int(groups * r / replicas) * copies);
  return first;
}

}  // namespace

Exchange::Exchange(int replicas, int rows, int copies)
    : first_rows_(FirstRows(replicas, rows, copies)), barrier_(replicas) {
  for (std::vector<Offer>& turn : offers_) turn.resize(size_t(replicas));
}

Replica::Replica(Exchange* exchange, int rank)
    : exchange_(exchange), rank_(rank), count_(exchange->replicas()) {
  CHECK(rank >= 0 && rank < count_) << rank << " of " << count_;
}

int Replica::threads() const { return exchange_ == nullptr ? Threads() : 1; }

Replica::Rows Replica::RowsOf(int batch) const {
  if (exchange_ == nullptr) return {0, batch};
  const std::vector<int>& first = exchange_->first_rows_;
  CHECK(batch == first.back()) << "batch of " << batch << ", expected " << first.back();
  return {first[size_t(rank_)], first[size_t(rank_) + 1] - first[size_t(rank_)]};
}

double Replica::WeightOf(int rank) const {
  if (exchange_ == nullptr) return 1;
  const std::vector<int>& first = exchange_->first_rows_;
  return double(first[size_t(rank) + 1] - first[size_t(rank)]) / first.back();
}

Replica::Share Replica::ShareOf(int64_t floats) const {
  if (count_ == 1) return {0, floats};
  CHECK(floats % kUnit == 0) << floats;
  const int64_t units = floats / kUnit;
  return {units * rank_ / count_ * kUnit, units * (rank_ + 1) / count_ * kUnit};
}

std::span<const Exchange::Offer> Replica::Shown() const {
  if (exchange_ == nullptr) return {&alone_, 1};
  return exchange_->offers_[turn_ % 2];
}

std::span<const Exchange::Offer> Replica::Show() {
  if (exchange_ == nullptr) {
    alone_ = std::exchange(next_, {});
    return Shown();
  }
  std::vector<Exchange::Offer>& offers = exchange_->offers_[++turn_ % 2];
  offers[size_t(rank_)] = std::exchange(next_, {});
  // A replica that is measured by itself reads its own offer in place of the others'.
  if (!exchange_->meets_)
    std::fill(offers.begin(), offers.end(), Exchange::Offer(offers[size_t(rank_)]));
  Meet();
  return Shown();
}

void Replica::Meet() {
  if (exchange_ != nullptr && exchange_->meets_) exchange_->barrier_.ArriveAndWait();
}

double Replica::Sum(double own) {
  next_.number = own;
  double sum = 0;
  for (const Exchange::Offer& offer : Show()) sum += offer.number;
  return sum;
}

std::vector<double> Replica::Means(std::initializer_list<double> own) {
  Post({}, own);
  Show();
  return Posted().means;
}

void Replica::Post(std::span<const std::span<const float>> arrays, std::vector<double> means) {
  next_.arrays.clear();
  for (const std::span<const float> values : arrays) {
    next_.arrays.emplace_back(values.begin(), values.end());
  }
  next_.means = std::move(means);
}

Replica::Whole Replica::Posted() const {
  const std::span<const Exchange::Offer> offers = Shown();
  Whole whole{offers[0].arrays, offers[0].means};
  if (count_ == 1) return whole;
  for (double& mean : whole.means) mean *= WeightOf(0);
  for (int rank = 1; rank < count_; ++rank) {
    const Exchange::Offer& offer = offers[size_t(rank)];
    for (size_t i = 0; i < whole.arrays.size(); ++i) {
      whole.arrays[i].insert(whole.arrays[i].end(), offer.arrays[i].begin(), offer.arrays[i].end());
    }
    for (size_t i = 0; i < whole.means.size(); ++i) {
      whole.means[i] += WeightOf(rank) * offer.means[i];
    }
  }
  return whole;
}

std::vector<double> Replica::Normals(int batch, int per_row, Random* random) const {
  const Rows rows = RowsOf(batch);
  const auto skip = [&](int count) {
    for (int64_t i = 0; i < int64_t{count} * per_row; ++i) random->SkipNormal();
  };
  skip(rows.begin);
  std::vector<double> own(size_t(rows.count) * size_t(per_row));
  for (double& value : own) value = random->Normal();
  skip(batch - rows.begin - rows.count);
  return own;
}

}  // namespace shoal::nn
