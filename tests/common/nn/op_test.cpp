// SPDX-License-Identifier: Apache-2.0
#include "common/nn/op.h"

#include <gtest/gtest.h>

#include <memory>

#include "common/nn/parallel.h"
#include "common/nn/precision.h"

namespace shoal::nn {
namespace {

// Outside a scope, a signal handler could overwrite memory during a product.
TEST(Op, RunsOnlyInAThreadScope) {
  const dnnl::memory from = MakeMemory(PlainF32({2})), to = MakeMemory(PlainF32({2}));
  static_cast<float*>(from.get_data_handle())[1] = 3;
  Op copy = Op::Reorder(from, to, std::make_shared<Scratchpad>());
  EXPECT_DEATH(copy.Run(), "outside a ThreadScope");
  const ThreadScope scope(1);
  copy.Run();
  EXPECT_EQ(static_cast<const float*>(to.get_data_handle())[1], 3);
}

}  // namespace
}  // namespace shoal::nn
