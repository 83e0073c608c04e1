#include "launch/record/accounting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint64_t kFirst = 1'700'000'000'000'000'001, kSecond = kFirst + 1;

// As a ring that agrees with its sessions would say.
SeenByReplay Seen(std::vector<SeenRecords> sessions) {
  SeenByReplay seen{.sessions = std::move(sessions)};
  for (const SeenRecords& session : seen.sessions) seen.stored_records += session.stored;
  return seen;
}

TEST(Account, SumsSessionsAndCountsWhatWasLostWithAProcess) {
  const MadeRecords made[] = {{0, kFirst, 100}, {0, kSecond, 50}, {1, kFirst, 7}};
  const SeenByReplay seen =
      Seen({{.actor = 0,
             .session = kFirst,
             .highest = 90,
             .stored = 80,
             .rejected = 4,
             .after_gap = 6,
             .duplicates = 5},
            {.actor = 0, .session = kSecond, .highest = 50, .stored = 50, .duplicates = 1}});
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
  const SeenByReplay seen =
      Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 6, .lost = 4}});
  const Accounting a = Account(made, seen, {.own_actors = 4, .outlives_replay = false});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.lost_with_process, 2u);
  EXPECT_EQ(a.lost_with_replay, 4u);
  EXPECT_EQ(a.made, a.stored + a.lost_with_process + a.lost_with_replay);
  EXPECT_THAT(a.Line(), HasSubstr("lost with a process 2 + lost with a replay 4 +"));
}

TEST(Account, WhatTheReplayFileLostIsAFault) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  const SeenByReplay seen =
      Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 6, .lost = 4}});
  EXPECT_THAT(Account(made, seen, {.own_actors = 4}).faults,
              ElementsAre(HasSubstr("4 records were reported stored in the replay file")));
}

TEST(Account, WhatWasInARemovedReplayFileIsLostWithTheReplay) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  SeenByReplay seen =
      Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 6, .lost = 4}});
  seen.ring_replaced = true;
  const Accounting a = Account(made, seen, {.own_actors = 4});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.lost_with_replay, 4u);
}

TEST(Account, HoldsTheSessionsAgainstTheRing) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  SeenByReplay seen = Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 10}});
  seen.stored_records = 9;
  EXPECT_THAT(Account(made, seen, {.own_actors = 4}).faults,
              ElementsAre(HasSubstr("stored 10 records, but 9 were put into the ring")));
}

TEST(Account, SaysWhichSessionTheReplayCannotExplain) {
  const MadeRecords made[] = {{3, kFirst, 100}};
  const SeenByReplay seen = Seen({{.actor = 3, .session = kFirst, .highest = 100, .stored = 99}});
  const Accounting a = Account(made, seen, {.own_actors = 4});
  EXPECT_THAT(a.faults,
              ElementsAre(AllOf(HasSubstr("actor 3"), HasSubstr("= 99"), HasSubstr("up to 100"))));
  EXPECT_THAT(a.Line(), HasSubstr("made 100 ? stored 99"));
}

TEST(Account, DoesNotLetAnExcessHideALoss) {
  const MadeRecords made[] = {{0, kFirst, 10}, {1, kFirst, 10}};
  const SeenByReplay seen = Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 11},
                                  {.actor = 1, .session = kFirst, .highest = 10, .stored = 9}});
  EXPECT_EQ(Account(made, seen, {.own_actors = 4}).faults.size(), 2u);
}

TEST(Account, RefusesRecordsThatNobodyMade) {
  const SeenByReplay seen = Seen({{.actor = 0, .session = kFirst, .highest = 5, .stored = 5}});
  EXPECT_THAT(Account({}, seen, {.own_actors = 4}).faults,
              ElementsAre(HasSubstr("but 0 were made")));
}

TEST(Account, CountsASessionElsewhereWithoutItsPageAsFarAsTheReplaySaw) {
  const MadeRecords made[] = {{0, kFirst, 10}};
  const SeenByReplay seen =
      Seen({{.actor = 0, .session = kFirst, .highest = 10, .stored = 10},
            {.actor = 1, .session = kFirst, .highest = 5, .stored = 4, .rejected = 1}});
  const Accounting a = Account(made, seen, {.own_actors = 1});
  EXPECT_TRUE(a.Balances());
  EXPECT_EQ(a.sessions_without_page, 1u);
  EXPECT_EQ(a.made, 15u);
  EXPECT_THAT(a.Line(), HasSubstr("1 session(s) without a counter page"));
  EXPECT_FALSE(Account(made, seen, {.own_actors = 2}).Balances()) << "actor 1 is one of our own";
}

TEST(Account, RefusesASessionListedTwice) {
  const MadeRecords made[] = {{0, kFirst, 5}};
  const SeenByReplay seen = Seen({{.actor = 0, .session = kFirst, .highest = 5, .stored = 5},
                                  {.actor = 0, .session = kFirst, .highest = 5, .stored = 5}});
  EXPECT_FALSE(Account(made, seen, {.own_actors = 4}).Balances());
}

TEST(ReadSeenByReplay, ReadsTheFileOfTheReplay) {
  const TemporaryFolder run;
  WriteFileAtomically(run.path() / "accounting.json",
                      R"({"schema": "shoal-accounting-1", "stored_records": 5,
    "ring_replaced": true, "sessions": [
    {"actor": 2, "session": 1700000000000000001, "highest": 9, "stored": 5, "rejected": 1,
     "after_gap": 2, "lost": 1, "duplicates": 4}]})");
  const auto seen = ReadSeenByReplay(run.path());
  EXPECT_EQ(seen.stored_records, 5u);
  EXPECT_TRUE(seen.ring_replaced);
  ASSERT_EQ(seen.sessions.size(), 1u);
  EXPECT_EQ(seen.sessions[0].actor, 2u);
  EXPECT_EQ(seen.sessions[0].session, kFirst) << "64 bits survive JSON";
  EXPECT_EQ(seen.sessions[0].highest, 9u);
  EXPECT_EQ(seen.sessions[0].stored, 5u);
  EXPECT_EQ(seen.sessions[0].rejected, 1u);
  EXPECT_EQ(seen.sessions[0].after_gap, 2u);
  EXPECT_EQ(seen.sessions[0].lost, 1u);
  EXPECT_EQ(seen.sessions[0].duplicates, 4u);
}

TEST(ReadSeenByReplay, RefusesABrokenFileByName) {
  const TemporaryFolder run;
  EXPECT_THROW(ReadSeenByReplay(run.path()), Error);
  for (const char* text : {"{", "{}", R"({"schema": "other", "sessions": []})",
                           R"({"schema": "shoal-accounting-1", "sessions": []})",
                           R"({"schema": "shoal-accounting-1", "stored_records": 0,
                               "sessions": [{"actor": 1}]})"}) {
    WriteFileAtomically(run.path() / "accounting.json", text);
    try {
      ReadSeenByReplay(run.path());
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("accounting.json"));
    }
  }
}

}  // namespace
}  // namespace shoal::launch
