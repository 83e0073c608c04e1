// SPDX-License-Identifier: Apache-2.0
#include "common/intake/credit_book.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

class CreditBookTest : public testing::Test {
 protected:
  void DealtWith(int session, uint64_t highest) {
    SessionCounters counters = table_.at(session);
    counters.highest = highest;
    table_.Update(session, counters);
  }
  std::vector<Credit> Changed(bool may_insert) {
    book_.Refresh(may_insert, steps_left_);
    return book_.Take(/*changed_only=*/true);
  }

  SessionLedger table_{8};
  std::optional<uint64_t> steps_left_;
  CreditBook book_{table_, /*spec_hash=*/5, /*receiver_session=*/77, /*window_records=*/10,
                   /*least_records=*/3};
};

TEST_F(CreditBookTest, ANewSessionGetsItsWindow) {
  table_.Add(3, 30);
  const auto credits = Changed(true);
  ASSERT_EQ(credits.size(), 1u);
  EXPECT_EQ(credits[0].actor, 3u);
  EXPECT_EQ(credits[0].session, 30u);
  EXPECT_EQ(credits[0].replay_session, 77u);
  EXPECT_EQ(credits[0].spec_hash, 5u);
  EXPECT_EQ(credits[0].stored, 0u);
  EXPECT_EQ(credits[0].allowed, 10u);
  EXPECT_TRUE(Changed(true).empty());
  EXPECT_EQ(book_.Take(/*changed_only=*/false).size(), 1u);
}

TEST_F(CreditBookTest, WithheldCreditReportsWhatIsStoredAndAllowsNoMore) {
  table_.Add(3, 30);
  Changed(true);
  DealtWith(0, 7);
  EXPECT_FALSE(book_.Withholding());
  const auto credits = Changed(false);
  ASSERT_EQ(credits.size(), 1u);
  EXPECT_EQ(credits[0].stored, 7u);
  EXPECT_EQ(credits[0].allowed, 10u);
  EXPECT_TRUE(book_.Withholding());
  EXPECT_EQ(Changed(true)[0].allowed, 17u);
  EXPECT_FALSE(book_.Withholding());
}

TEST_F(CreditBookTest, WordsAreUrgentToNewSessionsAndWhenHalfAWindowIsUsed) {
  EXPECT_FALSE(book_.Urgent());
  table_.Add(3, 30);
  book_.Refresh(true, steps_left_);
  EXPECT_TRUE(book_.Urgent()) << "it has heard nothing yet";
  book_.Take(true);
  EXPECT_FALSE(book_.Urgent());
  DealtWith(0, 4);
  book_.Refresh(true, steps_left_);
  EXPECT_FALSE(book_.Urgent()) << "six of ten are left";
  DealtWith(0, 5);
  book_.Refresh(true, steps_left_);
  EXPECT_TRUE(book_.Urgent());
  book_.Take(true);
  EXPECT_FALSE(book_.Urgent());
}

TEST_F(CreditBookTest, TheRestOfTheBudgetIsSharedEquallyAndLowersWhatWasAllowed) {
  table_.Add(3, 30);
  table_.Add(4, 40);
  steps_left_ = 21;
  for (const Credit& credit : Changed(true)) EXPECT_EQ(credit.allowed, 10u) << "a whole window";
  DealtWith(0, 9);
  steps_left_ = 12;
  const auto credits = Changed(true);
  ASSERT_EQ(credits.size(), 2u);
  EXPECT_EQ(credits[0].allowed, 15u);
  EXPECT_EQ(credits[1].allowed, 6u) << "the other one has used up some of it";
  DealtWith(0, 15);
  steps_left_ = 7;
  const auto withheld = Changed(false);
  ASSERT_EQ(withheld.size(), 2u);
  EXPECT_EQ(withheld[0].allowed, 15u) << "the limiter raises nothing";
  EXPECT_EQ(withheld[1].allowed, 4u);
}

TEST_F(CreditBookTest, AShareOfTheBudgetIsEnoughToGoOnUntilItIsSpent) {
  table_.Add(3, 30);
  table_.Add(4, 40);
  steps_left_ = 1;
  for (const Credit& credit : Changed(true)) EXPECT_EQ(credit.allowed, 3u);
  DealtWith(0, 3);
  steps_left_ = 0;
  const auto credits = Changed(true);
  ASSERT_EQ(credits.size(), 2u);
  EXPECT_EQ(credits[0].allowed, 3u);
  EXPECT_EQ(credits[1].allowed, 0u);
}

TEST_F(CreditBookTest, AllowedIsNeverLowerThanStored) {
  table_.Add(3, 30);
  Changed(false);
  DealtWith(0, 25);
  EXPECT_EQ(Changed(false)[0].allowed, 25u);
}

TEST_F(CreditBookTest, OnlyTheNewestSessionOfAnActorHasCredit) {
  table_.Add(3, 30);
  DealtWith(0, 9);
  table_.Add(4, 1);
  Changed(true);
  table_.Add(3, 31);
  const auto credits = Changed(true);
  ASSERT_EQ(credits.size(), 1u);
  EXPECT_EQ(credits[0].session, 31u);
  EXPECT_EQ(credits[0].allowed, 10u) << "sequences begin anew";
  EXPECT_EQ(book_.sessions(), 2);
  EXPECT_EQ(book_.Take(false).size(), 2u);
}

}  // namespace
}  // namespace shoal
