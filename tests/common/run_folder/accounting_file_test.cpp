// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/accounting_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const RunAccount kAccount{.stored_steps = 12,
                          .stored_records = 14,
                          .sessions = {{.actor = 1,
                                        .session = 1'700'000'000'000'000'001,
                                        .highest = 20,
                                        .rejected = 1,
                                        .after_gap = 2,
                                        .lost = 3,
                                        .discarded = 5,
                                        .duplicates = 4},
                                       {.actor = 2, .session = 5}}};

class AccountingFile : public ::testing::Test {
 protected:
  json Written() const { return json::parse(ReadFile(path_)); }
  std::string WhyRefused(const json& object) const {
    WriteFileAtomically(path_, object.dump());
    return ErrorMessage([&] { ReadAccount(run_.path()); });
  }

  const TemporaryFolder run_;
  const std::filesystem::path path_ = run_.path() / "accounting.json";
};

TEST_F(AccountingFile, ListsEverySessionWithItsCounters) {
  ReplaceAccount(run_.path(), kAccount);
  EXPECT_EQ(Written(), json::parse(R"({
    "schema": "shoal-accounting-1",
    "stored_steps": 12,
    "stored_records": 14,
    "ring_replaced": false,
    "sessions": [
      {"actor": 1, "session": 1700000000000000001, "highest": 20, "stored": 9, "rejected": 1,
       "after_gap": 2, "lost": 3, "discarded": 5, "duplicates": 4},
      {"actor": 2, "session": 5, "highest": 0, "stored": 0, "rejected": 0, "after_gap": 0,
       "lost": 0, "discarded": 0, "duplicates": 0}]})"));
}

TEST_F(AccountingFile, ReadsWhatWasWritten) {
  StoreAccount(run_.path(), kAccount);
  RunAccount account = ReadAccount(run_.path());
  EXPECT_EQ(account.stored_steps, 12u);
  EXPECT_EQ(account.stored_records, 14u);
  EXPECT_FALSE(account.ring_replaced);
  EXPECT_EQ(account.sessions, kAccount.sessions) << "64 bits survive JSON";
  account.ring_replaced = true;
  ReplaceAccount(run_.path(), account);
  EXPECT_TRUE(ReadAccountBefore(run_.path()).ring_replaced);
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".new"));
}

TEST_F(AccountingFile, BeforeTheFirstReceiverThereIsNoneOrZeros) {
  EXPECT_EQ(ReadAccountBefore(run_.path()).stored_steps, 0u);
  EXPECT_THROW(ReadAccount(run_.path()), Error);
}

TEST_F(AccountingFile, EarlierVersionsDiscardedNothing) {
  StoreAccount(run_.path(), kAccount);
  json object = Written();
  object.erase("ring_replaced");
  object["sessions"][1].erase("discarded");
  WriteFileAtomically(path_, object.dump());
  EXPECT_EQ(ReadAccount(run_.path()).sessions, kAccount.sessions);
}

TEST_F(AccountingFile, WhatIsWrongIsNamedWithItsMember) {
  StoreAccount(run_.path(), kAccount);
  const json good = Written();
  const auto refused = [&](const char* pointer, const json& value) {
    json object = good;
    object[json::json_pointer(pointer)] = value;
    return WhyRefused(object);
  };
  const auto names = [](const char* what) {
    return AllOf(HasSubstr("accounting.json'"), HasSubstr(what));
  };
  EXPECT_EQ(WhyRefused(good), "");
  EXPECT_THAT(WhyRefused(json()), names("shoal-accounting-1"));
  EXPECT_THAT(refused("/schema", "shoal-accounting-2"), names("shoal-accounting-1"));
  EXPECT_THAT(refused("/stored_steps", -1), names("'stored_steps': expected a count"));
  EXPECT_THAT(refused("/ring_replaced", 1), names("'ring_replaced': expected true or false"));
  EXPECT_THAT(refused("/sessions", 1), names("'sessions': expected a list"));
  EXPECT_THAT(refused("/sessions/1", 1), names("'sessions[1]': expected an object"));
  EXPECT_THAT(refused("/sessions/1/lost", 0.5), names("'sessions[1].lost': expected a count"));
  EXPECT_THAT(refused("/sessions/1/actor", uint64_t{1} << 32), names("'sessions[1].actor'"));
  EXPECT_THAT(refused("/sessions/0/stored", 8), names("'sessions[0].stored': 8 of actor 1"));
  EXPECT_THAT(refused("/sessions/1", good["sessions"][0]),
              names("'sessions[1].session': 1700000000000000001 of actor 1 is listed twice"));
  for (const char* member : {"stored_steps", "stored_records", "sessions"}) {
    json object = good;
    object.erase(member);
    EXPECT_THAT(WhyRefused(object), names(fmt::format("no '{}'", member).c_str()));
  }
  WriteFileAtomically(path_, "{");
  EXPECT_THAT(ErrorMessage([&] { ReadAccount(run_.path()); }), names("shoal-accounting-1"));
}

TEST_F(AccountingFile, SaysWhereItCannotBeWritten) {
  EXPECT_THAT(ErrorMessage([&] { ReplaceAccount(run_.path() / "missing", kAccount); }),
              HasSubstr("missing/accounting.json"));
}

}  // namespace
}  // namespace shoal
