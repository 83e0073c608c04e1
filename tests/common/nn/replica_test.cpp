// SPDX-License-Identifier: Apache-2.0
#include "common/nn/replica.h"

#include <gtest/gtest.h>

#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

// Ranks of replicas side by side, each with sets of parameters of its own.
class ReplicaTest : public testing::TestWithParam<int> {
 protected:
  ReplicaTest() {
    for (int rank = 0; rank < GetParam(); ++rank) replicas_.emplace_back(&exchange_, rank);
  }

  template <class Body>
  void Run(Body body) {
    team_.Run([&](int rank) { body(&replicas_[size_t(rank)]); });
  }

  Exchange exchange_{GetParam()};
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

TEST_P(ReplicaTest, PeersAreKnownByRankAndWhatWasWrittenBeforeAMeetingIsReadAfter) {
  const auto count = size_t(GetParam());
  std::vector<int> written(count), sums(count);
  Run([&](Replica* replica) {
    int* own = &written[size_t(replica->rank())];
    const std::vector<int*> peers = replica->Peers(own);
    for (int round = 1; round <= 50; ++round) {
      *own = round;
      replica->Meet();
      for (const int* peer : peers) sums[size_t(replica->rank())] += *peer;
      replica->Meet();
    }
    if (peers[size_t(replica->rank())] != own) sums[size_t(replica->rank())] = -1;
  });
  EXPECT_EQ(sums, std::vector<int>(count, int(count) * 50 * 51 / 2));
}

TEST_P(ReplicaTest, ArraysAndNumbersAreThoseOfTheWholeBatchForAll) {
  const int count = GetParam();
  std::vector<float> whole;
  double mean = 0;
  for (int rank = 0; rank < count; ++rank) {
    whole.insert(whole.end(), {float(rank), float(rank) + 0.5f});
    mean += double(rank * rank) / count;
  }
  std::vector<int> right(static_cast<size_t>(count));
  for (int round = 0; round < 50; ++round) {
    Run([&](Replica* replica) {
      const auto rank = float(replica->rank());
      const std::vector<float> two = {rank, rank + 0.5f}, none;
      const std::span<const float> own[] = {two, none};
      const auto all = replica->Whole(own);
      const auto means = replica->Means({double(rank) * rank, 7});
      right[size_t(replica->rank())] +=
          all.size() == 2 && all[0] == whole && all[1].empty() && means[0] == mean && means[1] == 7;
    });
  }
  EXPECT_EQ(right, std::vector<int>(size_t(count), 50));
}

TEST_P(ReplicaTest, DrawsTheNumbersThatOneReplicaWouldDraw) {
  Random alone(5);
  const int rows = 12, own = rows / GetParam();
  const std::vector<double> expected = Replica().Normals(rows, 3, &alone);
  std::vector<double> drawn;
  for (const Replica& replica : replicas_) {
    EXPECT_EQ(replica.Rows(rows), own);
    EXPECT_EQ(replica.threads(), 1);
    Random random(5);
    const std::vector<double> part = replica.Normals(own, 3, &random);
    drawn.insert(drawn.end(), part.begin(), part.end());
    EXPECT_EQ(random.state(), alone.state());
  }
  EXPECT_EQ(drawn, expected);
}

INSTANTIATE_TEST_SUITE_P(Of, ReplicaTest, testing::Values(2, 3, 4));

TEST(Replica, AloneGivesBackWhatItGot) {
  Replica alone;
  EXPECT_EQ(alone.Rows(7), 7);
  EXPECT_EQ(alone.threads(), Threads());
  EXPECT_EQ(alone.ShareOf(7).end, 7);
  EXPECT_EQ(alone.Peers(&alone), std::vector{&alone});
  const std::vector<float> values = {1, 2, 3};
  const std::span<const float> own[] = {values};
  EXPECT_EQ(alone.Whole(own), std::vector<std::vector<float>>{values});
  EXPECT_EQ(alone.Means({0.1, 0.2}), (std::vector<double>{0.1, 0.2}));
}

}  // namespace
}  // namespace shoal::nn
