// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "common/base/random.h"
#include "common/nn/adam.h"
#include "common/nn/module.h"
#include "common/nn/team.h"

namespace shoal::nn {
namespace {

constexpr double kRate = 0.01;
constexpr int64_t kSize = 10'007;  // several blocks of work and a remainder

std::vector<float> ValuesOf(const ParameterSet& set) {
  return {set.values(), set.values() + set.size()};
}

// Optimisers of replicas side by side, each of two sets of its own, and one alone that gets the
// mean of their gradients. The first set is smaller than what there is to share out.
class ReplicatedAdamTest : public testing::TestWithParam<int> {
 protected:
  struct Optimised {
    explicit Optimised(const Adam::Options& options, Replica* replica = nullptr)
        : adam({&small, &large}, options, replica) {}

    ParameterSet small{{{"s", {3}}}, ParameterSet::Use::kTraining};
    ParameterSet large{{{"w", {kSize}}}, ParameterSet::Use::kTraining};
    Adam adam;
  };

  ReplicatedAdamTest() {
    for (int rank = 0; rank < GetParam(); ++rank) {
      replicas_.emplace_back(&exchange_, rank);
      of_rank_.push_back(std::make_unique<Optimised>(options_, &replicas_.back()));
    }
  }

  // Other gradients for every rank; their mean, in the order of ranks, for the one alone.
  void SetGradients(uint64_t key) {
    Random random(key);
    for (const auto set : {&Optimised::small, &Optimised::large}) {
      ParameterSet& mean = alone_.*set;
      for (int64_t i = 0; i < mean.trained_size(); ++i) {
        float sum = 0;
        for (const auto& own : of_rank_) {
          const auto value = float(random.Normal());
          ((*own).*set).gradients()[i] = value;
          sum += value;
        }
        mean.gradients()[i] = sum * (1.f / float(GetParam()));
      }
    }
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
  Exchange exchange_{GetParam()};
  Team team_{GetParam()};
  std::deque<Replica> replicas_;
  std::vector<std::unique_ptr<Optimised>> of_rank_;
  Optimised alone_{options_};
};

TEST_P(ReplicatedAdamTest, TakesTheStepsOfOneWithTheMeanOfTheGradients) {
  for (uint64_t t = 1; t <= 3; ++t) {
    SetGradients(t);
    std::vector<double> squares;
    std::mutex mutex;
    Run([&](Adam* adam) {
      const double own = adam->GatherGradients();
      adam->Step();
      const std::scoped_lock lock(mutex);
      squares.push_back(own);
    });
    const double expected = alone_.adam.GatherGradients();
    alone_.adam.Step();
    for (const double own : squares) {
      EXPECT_EQ(own, squares[0]);
      EXPECT_NEAR(own / expected, 1, 1e-9);
    }
    ExpectAllEqualAlone();
  }
}

TEST_P(ReplicatedAdamTest, UndoesAndIsRestoredLikeOne) {
  SetGradients(1);
  Run([](Adam* adam) { adam->Step(); });
  alone_.adam.Step();
  SetGradients(2);
  Run([](Adam* adam) { adam->Step(); });
  Run([](Adam* adam) { adam->Undo(); });
  ExpectAllEqualAlone();
  TensorMap tensors;
  alone_.adam.Export("g", &tensors);
  Run([](Adam* adam) { adam->Step(); });  // elsewhere
  for (const auto& own : of_rank_) {
    own->adam.Import(tensors, "g", "test");
    CopyParameters(alone_.small, &own->small);
    CopyParameters(alone_.large, &own->large);
  }
  SetGradients(3);
  Run([](Adam* adam) { adam->Step(); });
  alone_.adam.Step();
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
  std::fill_n(alone.large.gradients(), kSize, float(GetParam() - 1) / 2);
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
