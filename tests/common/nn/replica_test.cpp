// SPDX-License-Identifier: Apache-2.0
#include "common/nn/replica.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

// Eleven transitions of two copies, which three or four replicas cannot divide evenly.
constexpr int kRows = 22, kCopies = 2;

// Ranks of replicas side by side.
class ReplicaTest : public testing::TestWithParam<int> {
 protected:
  ReplicaTest() {
    for (int rank = 0; rank < GetParam(); ++rank) replicas_.emplace_back(&exchange_, rank);
  }

  template <class Body>
  void Run(Body body) {
    team_.Run([&](int rank) { body(&replicas_[size_t(rank)]); });
  }

  Exchange exchange_{GetParam(), kRows, kCopies};
  Team team_{GetParam()};
  std::vector<Replica> replicas_;
};

TEST_P(ReplicaTest, SharesCoverAnArrayOnceInWholeCacheLines) {
  for (const int64_t floats : {0, 16, 32, 48, 4096}) {
    int64_t end = 0;
    for (const Replica& replica : replicas_) {
      const Replica::Share share = replica.ShareOf(floats);
      EXPECT_EQ(share.begin, end);
      EXPECT_EQ(share.begin % 16, 0);
      end = share.end;
    }
    EXPECT_EQ(end, floats);
  }
}

TEST_P(ReplicaTest, RowsCoverTheBatchOnceAndCopiesStayTogether) {
  int end = 0;
  double weights = 0;
  for (const Replica& replica : replicas_) {
    const Replica::Rows rows = replica.RowsOf(kRows);
    EXPECT_EQ(rows.begin, end);
    EXPECT_EQ(rows.begin % kCopies, 0);
    EXPECT_NEAR(rows.count, double(kRows) / GetParam(), kCopies);
    EXPECT_DOUBLE_EQ(replica.WeightOf(replica.rank()), double(rows.count) / kRows);
    end = rows.begin + rows.count;
    weights += replica.WeightOf(replica.rank());
  }
  EXPECT_EQ(end, kRows);
  EXPECT_DOUBLE_EQ(weights, 1);
  EXPECT_DEATH(replicas_[0].RowsOf(kRows + 1), "batch of 23, expected 22");
}

TEST_P(ReplicaTest, WhatWasWrittenBeforeAMeetingIsReadAfter) {
  const auto count = size_t(GetParam());
  std::vector<int> written(count), sums(count);
  Run([&](Replica* replica) {
    for (int round = 1; round <= 50; ++round) {
      written[size_t(replica->rank())] = round;
      replica->Meet();
      for (const int value : written) sums[size_t(replica->rank())] += value;
      replica->Meet();
    }
  });
  EXPECT_EQ(sums, std::vector<int>(count, int(count) * 50 * 51 / 2));
}

TEST_P(ReplicaTest, ShareTheObjectsThatTheFirstMakes) {
  std::vector<int*> first, second;
  int made = 0;
  const auto make = [&] { return std::make_shared<int>(++made); };
  for (Replica& replica : replicas_) {
    first.push_back(replica.Shared<int>(make).get());
    second.push_back(replica.Shared<int>(make).get());
  }
  EXPECT_EQ(made, 2);
  EXPECT_EQ(first, std::vector(first.size(), first[0]));
  EXPECT_EQ(second, std::vector(second.size(), second[0]));
  EXPECT_EQ(*first[0], 1);
  EXPECT_EQ(*second[0], 2);
}

// Each row's value is its number: the mean over the batch weighs each replica's by its rows.
TEST_P(ReplicaTest, ArraysSumsAndMeansAreThoseOfTheWholeBatchForAll) {
  const int count = GetParam();
  std::vector<float> whole;
  for (int row = 0; row < kRows; ++row) whole.push_back(float(row));
  auto right = std::vector<int>(size_t(count));
  for (int round = 0; round < 50; ++round) {
    Run([&](Replica* replica) {
      const Replica::Rows rows = replica->RowsOf(kRows);
      const std::vector<float> two(whole.begin() + rows.begin,
                                   whole.begin() + rows.begin + rows.count);
      const std::vector<float> none;
      const double mean = rows.begin + (rows.count - 1) / 2.;
      const std::span<const float> own[] = {two, none};
      replica->Post(own, {mean, 7});
      const double sum = replica->Sum(replica->rank() + 1);
      const Replica::Whole all = replica->Posted();
      const std::vector<double> means = replica->Means({mean});
      right[size_t(replica->rank())] +=
          all.arrays == std::vector{whole, none} && sum == count * (count + 1) / 2 &&
          std::abs(all.means[0] - (kRows - 1) / 2.) < 1e-12 && std::abs(all.means[1] - 7) < 1e-12 &&
          means[0] == all.means[0];
    });
  }
  EXPECT_EQ(right, std::vector<int>(size_t(count), 50));
}

TEST_P(ReplicaTest, DrawsTheNumbersThatOneReplicaWouldDraw) {
  Random alone(5);
  const std::vector<double> expected = Replica().Normals(kRows, 3, &alone);
  ASSERT_EQ(expected.size(), size_t(kRows) * 3);
  std::vector<double> drawn;
  for (const Replica& replica : replicas_) {
    EXPECT_EQ(replica.threads(), 1);
    Random random(5);
    const std::vector<double> part = replica.Normals(kRows, 3, &random);
    EXPECT_EQ(part.size(), size_t(replica.RowsOf(kRows).count) * 3);
    drawn.insert(drawn.end(), part.begin(), part.end());
    EXPECT_EQ(random.state(), alone.state());
  }
  EXPECT_EQ(drawn, expected);
}

INSTANTIATE_TEST_SUITE_P(Of, ReplicaTest, testing::Values(2, 3, 4));

TEST(Exchange, RefusesMoreReplicasThanTransitions) {
  EXPECT_DEATH(Exchange(12, kRows, kCopies), "11 groups of rows for 12 replicas");
}

TEST(Replica, AloneGivesBackWhatItGot) {
  Replica alone;
  EXPECT_EQ(alone.RowsOf(7).count, 7);
  EXPECT_EQ(alone.threads(), Threads());
  EXPECT_EQ(alone.ShareOf(7).end, 7);
  EXPECT_EQ(*alone.Shared<int>([] { return std::make_shared<int>(3); }), 3);
  const std::vector<float> values = {1, 2, 3};
  const std::span<const float> own[] = {values};
  alone.Post(own, {0.1, 0.2});
  EXPECT_EQ(alone.Sum(0.3), 0.3);
  EXPECT_EQ(alone.Posted().arrays, std::vector<std::vector<float>>{values});
  EXPECT_EQ(alone.Posted().means, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(alone.Means({0.1, 0.2}), (std::vector<double>{0.1, 0.2}));
}

}  // namespace
}  // namespace shoal::nn
