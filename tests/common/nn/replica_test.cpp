#include "common/nn/replica.h"

#include <gtest/gtest.h>

#include <memory>

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

TEST_P(ReplicaTest, GradientsBecomeTheirMeanInTheOrderOfRanks) {
  const int count = GetParam();
  // One set of fewer floats than there are to divide among ranks, one of several blocks.
  const std::vector<std::vector<int64_t>> shapes = {{3}, {70, 41}};
  std::vector<std::vector<std::unique_ptr<ParameterSet>>> sets(static_cast<size_t>(count));
  std::vector<std::vector<float>> mean(shapes.size());
  for (size_t s = 0; s < shapes.size(); ++s) {
    for (auto& of_rank : sets) {
      of_rank.push_back(std::make_unique<ParameterSet>(std::vector<ParameterSpec>{{"w", shapes[s]}},
                                                       ParameterSet::Use::kTraining));
    }
    mean[s].resize(size_t(sets[0][s]->trained_size()));
  }
  for (uint64_t round = 0; round < 3; ++round) {
    Random random(round);
    for (size_t s = 0; s < shapes.size(); ++s) {
      for (size_t i = 0; i < mean[s].size(); ++i) {
        float sum = 0;
        for (const auto& of_rank : sets) {
          const auto value = float(random.Normal());
          of_rank[s]->gradients()[i] = value;
          sum += value;
        }
        mean[s][i] = sum * (1.f / float(count));
      }
    }
    Run([&](Replica* replica) {
      const auto& own = sets[size_t(replica->rank())];
      replica->AverageGradients(std::vector<ParameterSet*>{own[0].get(), own[1].get()});
    });
    for (const auto& of_rank : sets) {
      for (size_t s = 0; s < shapes.size(); ++s) {
        const std::vector<float> got(of_rank[s]->gradients(),
                                     of_rank[s]->gradients() + mean[s].size());
        EXPECT_EQ(got, mean[s]) << "bit for bit";
      }
    }
  }
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
  const std::vector<float> values = {1, 2, 3};
  const std::span<const float> own[] = {values};
  EXPECT_EQ(alone.Whole(own), std::vector<std::vector<float>>{values});
  EXPECT_EQ(alone.Means({0.1, 0.2}), (std::vector<double>{0.1, 0.2}));
}

}  // namespace
}  // namespace shoal::nn
