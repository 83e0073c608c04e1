// SPDX-License-Identifier: Apache-2.0
#include "launch/record/accounting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint64_t kFirst = 1'700'000'000'000'000'001, kSecond = kFirst + 1;

// Account of a ring that agrees with its sessions.
RunAccount Seen(std::vector<SessionCounters> sessions) {
  RunAccount seen{.sessions = std::move(sessions)};
  for (const SessionCounters& session : seen.sessions) seen.stored_records += session.stored();
  return seen;
}

TEST(Account, SumsSessionsAndCountsWhatWasLostWithAProcess) {
  const MadeRecords made[] = {{0, kFirst, 100}, {0, kSecond, 50}, {1, kFirst, 7}};
  const RunAccount seen = Seen({{.actor = 0,
                                 .session = kFirst,
                                 .highest = 90,
                                 .rejected = 4,
                                 .after_gap = 6,
                                 .duplicates = 5},
                                {.actor = 0, .session = kSecond, .highest = 50, .duplicates = 1}});
  const Accounting a = Account(made, seen, {.resends = 9, .own_actors = 2});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.made, 157u);
  EXPECT_EQ(a.stored, 130u);
  EXPECT_EQ(a.lost_with_process, 10u + 7u) << "the third session was never seen";
  EXPECT_EQ(a.rejected, 4u);
  EXPECT_EQ(a.after_gap, 6u);
  EXPECT_EQ(a.duplicates, 6u);
  EXPECT_EQ(a.resends, 9u);
  EXPECT_EQ(a.made, a.stored + a.lost_with_process + a.rejected + a.after_gap);
  EXPECT_EQ(a.lost_with_replay, 0u);
  EXPECT_THAT(a.Line(), HasSubstr("made 157 = stored 130 + lost with a process 17 +"));
}

TEST(Account, CountsWhatTheMemoryOfAKilledReplayHeldAsLost) {
  const MadeRecords made[] = {{0, kFirst, 12}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10, .lost = 4}});
  const Accounting a = Account(made, seen, {.own_actors = 4, .outlives_replay = false});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.lost_with_process, 2u);
  EXPECT_EQ(a.lost_with_replay, 4u);
  EXPECT_EQ(a.made, a.stored + a.lost_with_process + a.lost_with_replay);
  EXPECT_THAT(a.Line(), HasSubstr("lost with a process 2 + lost with a replay 4 +"));
}

TEST(Account, WhatTheReplayFileLostIsAFault) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10, .lost = 4}});
  EXPECT_THAT(
      Account(made, seen, {.own_actors = 4}).faults,
      ElementsAre(HasSubstr("4 records were acknowledged but are missing in the replay file")));
}

TEST(Account, WhatWasInARemovedReplayFileIsLostWithTheReplay) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10, .lost = 4}});
  seen.ring_replaced = true;
  const Accounting a = Account(made, seen, {.own_actors = 4});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.lost_with_replay, 4u);
}

TEST(Account, OfALostPageTheReplaysCountIsTaken) {
  const MadeRecords made[] = {{.actor = 0, .session = kFirst, .made = 7, .known = false},
                              {.actor = 1, .session = kFirst, .made = 12}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10},
                                {.actor = 1, .session = kFirst, .highest = 10}});
  const Accounting a = Account(made, seen, {.own_actors = 4});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.made, 22u);
  EXPECT_EQ(a.lost_with_process, 2u);
  EXPECT_EQ(a.sessions_without_page, 1u);
  EXPECT_THAT(a.Line(), HasSubstr("1 session(s) without a counter page"));
}

TEST(Account, HoldsTheSessionsAgainstTheRing) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10}});
  seen.stored_records = 9;
  EXPECT_THAT(Account(made, seen, {.own_actors = 4}).faults,
              ElementsAre(HasSubstr("stored 10 records, but 9 were put into the ring")));
}

TEST(Account, WhatDoesNotBalanceIsSaidOfItsSession) {
  const MadeRecords made[] = {{3, kFirst, 100}};
  const Accounting a =
      Account(made, Seen({{.actor = 3, .session = kFirst, .highest = 101}}), {.own_actors = 4});
  EXPECT_THAT(a.faults, ElementsAre(AllOf(HasSubstr("actor 3"), HasSubstr("saw sequence 101"))));
  EXPECT_THAT(a.Line(), HasSubstr("made 100 ? stored 101"));
}

TEST(Account, DoesNotLetAnExcessHideALoss) {
  const MadeRecords made[] = {{0, kFirst, 10}, {1, kFirst, 10}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 11},
                                {.actor = 1, .session = kFirst, .highest = 9}});
  const Accounting a = Account(made, seen, {.own_actors = 4});
  EXPECT_THAT(a.faults, ElementsAre(HasSubstr("saw sequence 11, but 10 were made")));
  EXPECT_EQ(a.lost_with_process, 1u);
}

TEST(Account, RefusesRecordsThatNobodyMade) {
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 5}});
  EXPECT_THAT(Account({}, seen, {.own_actors = 4}).faults,
              ElementsAre(HasSubstr("but 0 were made")));
}

TEST(Account, CountsASessionElsewhereWithoutItsPageAsFarAsTheReplaySaw) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 10},
                                {.actor = 1, .session = kFirst, .highest = 5, .rejected = 1}});
  const Accounting a = Account(made, seen, {.own_actors = 1});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.sessions_without_page, 1u);
  EXPECT_EQ(a.made, 15u);
  EXPECT_THAT(a.Line(), HasSubstr("1 session(s) without a counter page"));
  EXPECT_FALSE(Account(made, seen, {.own_actors = 2}).Balances()) << "actor 1 is one of our own";
}

TEST(Account, RefusesASessionListedTwice) {
  const MadeRecords made[] = {{0, kFirst, 5}};
  const RunAccount seen = Seen({{.actor = 0, .session = kFirst, .highest = 5},
                                {.actor = 0, .session = kFirst, .highest = 5}});
  EXPECT_FALSE(Account(made, seen, {.own_actors = 4}).Balances());
}

}  // namespace
}  // namespace shoal::launch
