// SPDX-License-Identifier: Apache-2.0
#include "common/nn/laid_out_weight.h"

#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"
#include "common/nn/replica.h"

namespace shoal::nn {
namespace {

struct Shape {
  int64_t outputs, inputs;
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.outputs << "x" << shape.inputs;
}

// Weights that a linear layer of few rows reads, in the type of its precision.
dnnl::memory::desc Wanted(const Shape& shape, Precision precision, int rows) {
  const dnnl::memory::data_type type = ComputeType(precision);
  return DescribeForward<dnnl::inner_product_forward>(
             Attributes(), dnnl::prop_kind::forward_training, Plain({rows, shape.inputs}, type),
             AnyLayout({shape.outputs, shape.inputs}, type), PlainF32({shape.outputs}),
             PlainF32({rows, shape.outputs}))
      .weights_desc();
}

std::vector<uint8_t> BytesOf(const dnnl::memory& memory) {
  const auto* bytes = static_cast<const uint8_t*>(memory.get_data_handle());
  return {bytes, bytes + memory.get_desc().get_size()};
}

void Fill(uint64_t key, ParameterSet* set) {
  Random random(key);
  float* values = set->Find("w").value();
  const std::vector<int64_t>& shape = set->Find("w").shape();
  for (int64_t i = 0; i < shape[0] * shape[1]; ++i) values[i] = float(random.Normal());
}

// One weight of N replicas, with two readers of the same layout in each, and of one alone.
class SharedLayoutsTest : public testing::TestWithParam<std::tuple<Shape, Precision, int>> {
 protected:
  struct Of {
    Of(const Shape& shape, const dnnl::memory::desc& wanted, Replica* replica)
        : set({{"w", {shape.outputs, shape.inputs}}}, ParameterSet::Use::kTraining, replica),
          forward(set.Find("w"), wanted, scratchpad),
          backward(set.Find("w"), wanted, scratchpad) {}

    void Refresh() {
      forward.Refresh();
      backward.Refresh();
    }

    const std::shared_ptr<Scratchpad> scratchpad = std::make_shared<Scratchpad>();
    ParameterSet set;
    LaidOutWeight forward, backward;
  };

  SharedLayoutsTest() {
    const auto [shape, precision, count] = GetParam();
    if (precision == Precision::kBf16 && ChoosePrecision("auto", true) != Precision::kBf16) return;
    const dnnl::memory::desc wanted = Wanted(shape, precision, 8);
    exchange_ = std::make_unique<Exchange>(count, count);
    for (int rank = 0; rank < count; ++rank) {
      replicas_.emplace_back(exchange_.get(), rank);
      of_rank_.push_back(std::make_unique<Of>(shape, wanted, &replicas_.back()));
    }
    alone_ = std::make_unique<Of>(shape, wanted, nullptr);
  }

  const ThreadScope one_thread_{1};
  std::unique_ptr<Exchange> exchange_;
  std::deque<Replica> replicas_;
  std::vector<std::unique_ptr<Of>> of_rank_;
  std::unique_ptr<Of> alone_;
};

TEST_P(SharedLayoutsTest, HoldWhatOneAloneWouldHaveOnceAllHaveRefreshed) {
  if (!alone_) GTEST_SKIP() << "this CPU has no bf16 arithmetic";
  for (uint64_t round = 1; round <= 3; ++round) {
    Fill(round, &alone_->set);
    Fill(round, &of_rank_[0]->set);  // for all
    alone_->Refresh();
    for (const auto& of : of_rank_) of->Refresh();
    for (const auto& of : of_rank_) {
      EXPECT_EQ(BytesOf(of->forward.memory()), BytesOf(alone_->forward.memory()));
      EXPECT_EQ(BytesOf(of->backward.memory()), BytesOf(alone_->forward.memory()));
    }
  }
}

// A layout of few pieces has fewer writers than there are replicas.
TEST_P(SharedLayoutsTest, AreWrittenInPiecesByDifferentReplicas) {
  if (!alone_) GTEST_SKIP() << "this CPU has no bf16 arithmetic";
  const auto [shape, precision, count] = GetParam();
  const bool cut =
      shape.outputs * shape.inputs >= 4 * 8192 && std::max(shape.outputs, shape.inputs) % 64 == 0;
  if (alone_->forward.memory().get_desc() == PlainF32({shape.outputs, shape.inputs})) return;
  Fill(1, &of_rank_[0]->set);
  int writers = 0;
  for (const auto& of : of_rank_) {
    const std::vector<uint8_t> before = BytesOf(of->forward.memory());
    of->Refresh();
    writers += BytesOf(of->forward.memory()) != before;
  }
  EXPECT_EQ(writers, cut ? count : 1);
}

INSTANTIATE_TEST_SUITE_P(Of, SharedLayoutsTest,
                         testing::Combine(testing::Values(Shape{50, 2048}, Shape{256, 256},
                                                          Shape{256, 54}, Shape{64, 1000}),
                                          testing::Values(Precision::kF32, Precision::kBf16),
                                          testing::Values(2, 3)));

}  // namespace
}  // namespace shoal::nn
