// SPDX-License-Identifier: Apache-2.0
#include "common/nn/rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"

namespace shoal::nn {
namespace {

TEST(Rows, MoreNumbersThanAnIntHoldsAreRefusedBeforeTheyTakeMemory) {
  const auto refusal = [](int batch, int columns) {
    return ErrorMessage([&] { Rows(batch, columns, Precision::kF32); });
  };
  EXPECT_EQ(refusal(64, 64), "");
  EXPECT_THAT(refusal(65'536, 65'536),
              testing::HasSubstr("65536 rows of 65536 numbers are "
                                 "4294967296; expected at most 2147483647"));
}

}  // namespace
}  // namespace shoal::nn
