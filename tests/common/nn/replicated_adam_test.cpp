// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "common/nn/adam.h"
#include "common/nn/module.h"
#include "common/nn/team.h"

namespace shoal::nn {
namespace {

constexpr double kRate = 0.01;
constexpr int64_t kSize = 10'007;  // several blocks of work and a remainder
constexpr int kRowsOfAll = 11;     // of a batch: not the same number for each replica

std::vector<float> ValuesOf(const ParameterSet& set) {
  return {set.values(), set.values() + set.size()};
}

// Optimisers of replicas, each with two sets of shared values, and a single optimiser that gets the
// mean of their gradients. The first set is smaller than the smallest unit that replicas share out.
class ReplicatedAdamTest : public testing::TestWithParam<int> {
 protected:
  struct Optimised {
    explicit Optimised(const Adam::Options& options, Replica* replica = nullptr)
        : small({{"s", {3}}}, ParameterSet::Use::kTraining, replica),
          large({{"w", {kSize}}}, ParameterSet::Use::kTraining, replica),
          adam({&small, &large}, options, replica) {}

    ParameterSet small, large;
    Adam adam;
  };

  ReplicatedAdamTest() {
    for (int rank = 0; rank < GetParam(); ++rank) {
      replicas_.emplace_back(&exchange_, rank);
      of_rank_.push_back(std::make_unique<Optimised>(options_, &replicas_.back()));
    }
  }

  // Other gradients for every rank.
  void SetGradients(uint64_t key) {
    Random random(key);
    for (const auto& own : of_rank_) {
      for (const auto set : {&Optimised::small, &Optimised::large}) {
        for (int64_t i = 0; i < (*own.*set).trained_size(); ++i) {
          (*own.*set).gradients()[i] = float(random.Normal());
        }
      }
    }
  }

  // A step of all, and one of the one alone by the gradients that each rank averaged in its share.
  void Step() {
    std::vector<double> squares(of_rank_.size());
    const std::vector<std::vector<double>> means = {MeanOverRows(&Optimised::small),
                                                    MeanOverRows(&Optimised::large)};
    team_.Run(
        [&](int rank) { squares[size_t(rank)] = of_rank_[size_t(rank)]->adam.GatherGradients(); });
    TakeShares(&Optimised::small, means[0]);
    TakeShares(&Optimised::large, means[1]);
    Run([](Adam* adam) { adam->Step(); });
    const double expected = alone_.adam.GatherGradients();
    alone_.adam.Step();
    for (const double own : squares) {
      EXPECT_EQ(own, squares[0]);
      EXPECT_NEAR(own / expected, 1, 1e-9);
    }
  }

  std::vector<double> MeanOverRows(ParameterSet Optimised::*set) {
    std::vector<double> mean(size_t((alone_.*set).trained_size()));
    for (size_t r = 0; r < of_rank_.size(); ++r) {
      const double weight = double(replicas_[r].RowsOf(kRowsOfAll).count) / kRowsOfAll;
      for (size_t i = 0; i < mean.size(); ++i) {
        mean[i] += weight * (*of_rank_[r].*set).gradients()[i];
      }
    }
    return mean;
  }

  void TakeShares(ParameterSet Optimised::*set, const std::vector<double>& mean) {
    float* gradients = (alone_.*set).gradients();
    for (size_t r = 0; r < of_rank_.size(); ++r) {
      const auto [begin, end] = replicas_[r].ShareOf(int64_t(mean.size()));
      std::copy(&(*of_rank_[r].*set).gradients()[begin], &(*of_rank_[r].*set).gradients()[end],
                gradients + begin);
    }
    for (size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(gradients[i], mean[i], 1e-6) << i;
  }

  template <class Body>
  void Run(Body body) {
    team_.Run([&](int rank) { body(&of_rank_[size_t(rank)]->adam); });
  }

  void ExpectAllEqualAlone() {
    for (const auto& own : of_rank_) {
      EXPECT_EQ(ValuesOf(own->large), ValuesOf(alone_.large)) << "bit for bit";
      EXPECT_EQ(ValuesOf(own->small), ValuesOf(alone_.small)) << "bit for bit";
    }
    TensorMap expected, kept;
    alone_.adam.Export("g", &expected);
    of_rank_[0]->adam.Export("g", &kept);
    for (const auto& [name, tensor] : expected) EXPECT_EQ(kept.at(name).data, tensor.data) << name;
  }

  const Adam::Options options_{.rate = kRate, .max_norm = 1e6};
  Exchange exchange_{GetParam(), kRowsOfAll};
  Team team_{GetParam()};
  std::deque<Replica> replicas_;
  std::vector<std::unique_ptr<Optimised>> of_rank_;
  Optimised alone_{options_};
};

TEST_P(ReplicatedAdamTest, TakesTheStepsOfOneWithTheMeanOfTheGradients) {
  for (uint64_t t = 1; t <= 3; ++t) {
    SetGradients(t);
    Step();
    ExpectAllEqualAlone();
  }
}

TEST_P(ReplicatedAdamTest, UndoesAndIsRestoredLikeOne) {
  SetGradients(1);
  Step();
  TensorMap tensors;
  alone_.adam.Export("g", &tensors);
  const std::vector<float> small = ValuesOf(alone_.small), large = ValuesOf(alone_.large);
  SetGradients(2);
  Step();
  Run([](Adam* adam) { adam->Undo(); });
  alone_.adam.Undo();
  ExpectAllEqualAlone();
  EXPECT_EQ(ValuesOf(alone_.large), large);
  SetGradients(3);
  Step();  // elsewhere
  for (const auto& own : of_rank_) {
    own->adam.Import(tensors, "g", "test");
    std::ranges::copy(small, own->small.values());
    std::ranges::copy(large, own->large.values());
  }
  alone_.adam.Import(tensors, "g", "test");
  std::ranges::copy(small, alone_.small.values());
  std::ranges::copy(large, alone_.large.values());
  ExpectAllEqualAlone();
  SetGradients(4);
  Step();
  ExpectAllEqualAlone();
}

TEST_P(ReplicatedAdamTest, ClipsTheNormOfTheMean) {
  const double norm = 0.5;
  Optimised alone({.rate = kRate, .epsilon = 1, .max_norm = norm});
  std::deque<Optimised> clipped;
  for (Replica& replica : replicas_) {
    clipped.emplace_back(Adam::Options{.rate = kRate, .epsilon = 1, .max_norm = norm}, &replica);
    std::fill_n(clipped.back().large.gradients(), kSize, float(replica.rank()));
  }
  double mean = 0;
  for (const Replica& replica : replicas_)
    mean += replica.WeightOf(replica.rank()) * replica.rank();
  std::fill_n(alone.large.gradients(), kSize, float(mean));
  team_.Run([&](int rank) { clipped[size_t(rank)].adam.Step(); });
  alone.adam.Step();
  for (Optimised& own : clipped) {
    for (size_t i = 0; i < size_t(kSize); i += 997) {
      EXPECT_NEAR(ValuesOf(own.large)[i], ValuesOf(alone.large)[i], 1e-9);
    }
  }
  EXPECT_LT(ValuesOf(alone.large)[0], 0);
}

INSTANTIATE_TEST_SUITE_P(Of, ReplicatedAdamTest, testing::Values(2, 3, 4));

}  // namespace
}  // namespace shoal::nn
