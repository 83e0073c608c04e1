// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/session_table.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/base/error.h"

namespace shoal::replay {
namespace {

class SessionTableTest : public testing::Test {
 protected:
  std::vector<StoredSession> storage_ = std::vector<StoredSession>(4);
};

TEST_F(SessionTableTest, CountersOutliveTheTable) {
  const SessionCounters counters{.actor = 3,
                                 .session = 30,
                                 .highest = 20,
                                 .rejected = 1,
                                 .after_gap = 2,
                                 .lost = 3,
                                 .duplicates = 4};
  {
    SessionTable table(storage_);
    table.Add(2, 20);
    table.Update(*table.Add(3, 30), counters);
  }
  const SessionTable table(storage_);
  ASSERT_EQ(table.size(), 2);
  EXPECT_EQ(table.at(*table.Find(3, 30)), counters);
  EXPECT_EQ(counters.stored(), 14u);
  EXPECT_EQ(table.TotalStored(), 14u);
  EXPECT_FALSE(table.Find(3, 20).has_value());
}

TEST_F(SessionTableTest, WhatAFormerServerStoredOrDiscardedIsLost) {
  SessionTable table(storage_);
  table.TakeOver(
      {.sessions = {{.actor = 1, .session = 7, .highest = 20, .lost = 3, .discarded = 5}}});
  const SessionCounters& counters = table.at(*table.Find(1, 7));
  EXPECT_EQ(counters.lost, 20u);
  EXPECT_EQ(counters.discarded, 0u);
  EXPECT_EQ(counters.stored(), 0u);
}

TEST_F(SessionTableTest, AnUpdateCutShortLeavesTheFormerCounters) {
  {
    SessionTable table(storage_);
    table.Add(1, 10);
    table.Update(0, {.actor = 1, .session = 10, .highest = 5});
    table.Update(0, {.actor = 1, .session = 10, .highest = 6});
  }
  // Version 3 is in copy 1; the writer died after it had begun to change it.
  storage_[0].copies[1].check = 0;
  storage_[0].copies[1].highest = 999;
  EXPECT_EQ(SessionTable(storage_).at(0).highest, 5u);
}

// The ring's file was replaced by a copy that was made earlier.
TEST_F(SessionTableTest, WhatAnEarlierServerStoredBeyondThisTableIsLost) {
  SessionTable table(storage_);
  table.Update(*table.Add(0, 10), {.actor = 0, .session = 10, .highest = 5, .after_gap = 1});
  const FormerServer former{
      .sessions = {{.actor = 0, .session = 10, .highest = 9, .rejected = 1, .after_gap = 1},
                   {.actor = 1, .session = 11, .highest = 3}}};
  EXPECT_TRUE(table.StoresLessThan(former));
  table.TakeOver(former);
  EXPECT_EQ(table.at(0).highest, 9u);
  EXPECT_EQ(table.at(0).stored(), 4u) << "as many as the ring has";
  EXPECT_EQ(table.at(0).lost, 3u);
  EXPECT_EQ(table.at(1).lost, 3u);
  EXPECT_TRUE(table.StoresLessThan(former)) << "a second start tells the same";
  const std::vector<SessionCounters> once = table.all();
  table.TakeOver(former);
  EXPECT_EQ(table.all(), once) << "nothing is counted twice";
}

TEST_F(SessionTableTest, AServerThatKnewNoMoreChangesNothing) {
  SessionTable table(storage_);
  const SessionCounters counters{.actor = 0, .session = 10, .highest = 5};
  table.Update(*table.Add(0, 10), counters);
  const FormerServer former{.sessions = {{.actor = 0, .session = 10, .highest = 4}}};
  table.TakeOver(former);
  EXPECT_EQ(table.at(0), counters);
  EXPECT_FALSE(table.StoresLessThan(former));
}

TEST_F(SessionTableTest, AnAddCutShortLeavesNoSession) {
  { SessionTable(storage_).Add(1, 10); }
  storage_[0].copies[1].check = 0;
  SessionTable table(storage_);
  EXPECT_EQ(table.size(), 0);
  EXPECT_EQ(*table.Add(1, 11), 0);
  EXPECT_EQ(SessionTable(storage_).at(0).session, 11u);
}

TEST_F(SessionTableTest, RefusesASessionWithTwoDamagedCopies) {
  {
    SessionTable table(storage_);
    table.Add(1, 10);
    table.Update(0, {.actor = 1, .session = 10, .highest = 5});
  }
  storage_[0].copies[0].highest ^= 1;
  storage_[0].copies[1].highest ^= 1;
  EXPECT_THROW(SessionTable{storage_}, Error);
}

TEST_F(SessionTableTest, TheNewestSessionOfAnActorIsTheOneThatStartedLast) {
  SessionTable table(storage_);
  table.Add(1, 20);
  table.Add(1, 10);
  table.Add(2, 5);
  EXPECT_EQ(table.at(*table.Newest(1)).session, 20u);
  EXPECT_EQ(table.newest().size(), 2u);
  EXPECT_FALSE(table.Newest(3).has_value());
}

TEST_F(SessionTableTest, IsBounded) {
  SessionTable table(storage_);
  for (uint64_t session = 1; session <= 4; ++session) EXPECT_TRUE(table.Add(1, session));
  EXPECT_FALSE(table.Add(1, 5));
}

}  // namespace
}  // namespace shoal::replay
