// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/aligned_table.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

TEST(AlignedTable, HasEqualColumnsAndNoSpacesAtTheEnd) {
  EXPECT_EQ(AlignedTable({{"ARM", "X", "Y"}, {"long-name", "1", ""}, {"b"}}),
            "ARM        X  Y\n"
            "long-name  1\n"
            "b\n");
}

}  // namespace
}  // namespace shoal::launch
