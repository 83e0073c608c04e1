// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/policy_average.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "common/nn/team.h"
#include "learner/engine/cpu_engine.h"

namespace shoal::learner {
namespace {

using nn::ParameterSet;

// The same policy, of two sets, in every replica and in a single one. The first set is smaller than
// the smallest unit that replicas share out.
class PolicyAverageTest : public testing::TestWithParam<int> {
 protected:
  struct Averaged {
    explicit Averaged(nn::Replica* replica)
        : engine(nn::Precision::kF32, GetParam(), replica), average({&small, &large}, &engine) {}

    ParameterSet small{{{"encoder.s", {3}}}, ParameterSet::Use::kTraining};
    ParameterSet large{{{"actor.w", {10'007}}}, ParameterSet::Use::kTraining};
    CpuEngine engine;
    PolicyAverage average;
  };

  PolicyAverageTest() {
    for (int rank = 0; rank < GetParam(); ++rank) {
      replicas_.emplace_back(&exchange_, rank);
      of_rank_.push_back(std::make_unique<Averaged>(&replicas_.back()));
    }
  }

  static void Fill(uint64_t key, Averaged* averaged) {
    Random random(key);
    for (ParameterSet* set : {&averaged->small, &averaged->large}) {
      for (int64_t i = 0; i < set->size(); ++i) set->values()[i] = float(random.Normal());
    }
  }

  nn::Exchange exchange_{GetParam(), GetParam()};
  nn::Team team_{GetParam()};
  std::deque<nn::Replica> replicas_;
  std::vector<std::unique_ptr<Averaged>> of_rank_;
  nn::Replica only_;
  Averaged alone_{&only_};
};

TEST_P(PolicyAverageTest, IsThatOfOneAloneInEachReplica) {
  Fill(1, &alone_);
  alone_.average.Copy();
  for (const auto& own : of_rank_) {
    Fill(1, own.get());
    own->average.Copy();
  }
  for (uint64_t t = 2; t <= 4; ++t) {
    Fill(t, &alone_);
    for (const auto& own : of_rank_) Fill(t, own.get());
    alone_.average.Move(0.25f);
    team_.Run([&](int rank) { of_rank_[size_t(rank)]->average.Move(0.25f); });
  }
  const nn::TensorMap expected = alone_.average.Tensors();
  ASSERT_EQ(expected.size(), 2u);
  for (size_t rank = 0; rank < of_rank_.size(); ++rank) {
    const nn::TensorMap kept = of_rank_[rank]->average.Tensors();
    ASSERT_EQ(kept.size(), 2u);
    for (const auto& [name, tensor] : kept) {
      EXPECT_EQ(tensor.data, expected.at(name).data) << name << ": bit for bit";
    }
  }
}

TEST_P(PolicyAverageTest, MovesByTheRateTowardsThePolicy) {
  for (const auto& own : of_rank_) {
    std::fill_n(own->large.values(), own->large.size(), 1.f);
    own->average.Copy();
    std::fill_n(own->large.values(), own->large.size(), 3.f);
  }
  team_.Run([&](int rank) { of_rank_[size_t(rank)]->average.Move(0.25f); });
  const nn::TensorMap kept = of_rank_[0]->average.Tensors();
  std::vector<float> values(10'007);
  ASSERT_EQ(kept.at("actor.w").data.size(), values.size() * sizeof(float));
  std::memcpy(values.data(), kept.at("actor.w").data.data(), values.size() * sizeof(float));
  EXPECT_EQ(values, std::vector<float>(values.size(), 1.5f));
}

INSTANTIATE_TEST_SUITE_P(Of, PolicyAverageTest, testing::Values(1, 2, 3));

}  // namespace
}  // namespace shoal::learner
