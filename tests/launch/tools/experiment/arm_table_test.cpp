// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/arm_table.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

TEST(ArmTable, HasEqualColumnsAndSaysWhatFailed) {
  SeedFigures good, bad;
  good.Add(0.5, 10, -2, std::nullopt);
  bad.failed = 1;
  EXPECT_EQ(
      ArmTable({{"long-name", good, 2}, {"b", bad, 1}}),
      "ARM        FINISHED       SUCCESS [95 %]              RETURN [95 %]   DISTANCE, cm [95 %]\n"
      "long-name  1/2            50.0 % [23.7, 76.3] (5/10)  -2.00 (1 seed)  -\n"
      "b          0/1, 1 failed  -                           - (1 failed)    -\n");
}

TEST(SetAggregates, ReplacesThoseOfAnArm) {
  SeedFigures figures;
  figures.Add(1.0, 10, -2, 0.01);
  nlohmann::ordered_json arm{{"name", "a"}, {"success", {{"wilson95", "old"}}}};
  SetAggregates(figures, &arm);
  EXPECT_EQ(arm.at("name"), "a");
  EXPECT_EQ(arm.at("success").at("pooled"), 1.0);
  EXPECT_EQ(arm.at("return").at("mean"), -2.0);
  EXPECT_EQ(arm.at("final_distance").at("mean"), 0.01);
}

}  // namespace
}  // namespace shoal::launch
