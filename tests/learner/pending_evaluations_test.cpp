// SPDX-License-Identifier: Apache-2.0
#include "learner/pending_evaluations.h"

#include <gtest/gtest.h>

namespace shoal::learner {
namespace {

using Names = std::set<std::string>;

TEST(PendingEvaluations, AnEvaluationLetsGoOfThoseBeforeItButNotOfItself) {
  PendingEvaluations pending;
  pending.Add(10, "a");
  pending.Add(20, "b");
  pending.Add(30, "c");
  pending.OnEvaluated(20);  // a was passed over
  EXPECT_EQ(pending.Names(), (Names{"b", "c"}));
  pending.OnEvaluated(30);
  EXPECT_EQ(pending.Names(), (Names{"c"}));
}

TEST(PendingEvaluations, IsBoundedWithoutAnEvaluationActor) {
  PendingEvaluations pending;
  for (uint64_t i = 1; i <= 20; ++i) pending.Add(i, std::to_string(i));
  EXPECT_EQ(pending.Names().size(), PendingEvaluations::kMost);
  EXPECT_TRUE(pending.Names().contains("20"));
  EXPECT_TRUE(pending.Names().contains("15"));
}

}  // namespace
}  // namespace shoal::learner
