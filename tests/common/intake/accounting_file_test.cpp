#include "common/intake/accounting_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

TEST(AccountingFile, ListsEverySessionWithItsCounters) {
  SessionLedger table(4);
  table.Add(1, 1'700'000'000'000'000'001);
  table.Update(0, {.actor = 1,
                   .session = 1'700'000'000'000'000'001,
                   .highest = 20,
                   .rejected = 1,
                   .after_gap = 2,
                   .lost = 3,
                   .discarded = 5,
                   .duplicates = 4});
  table.Add(2, 5);
  EXPECT_EQ(
      nlohmann::json::parse(AccountingJson(table, {.stored_steps = 12, .stored_records = 14})),
      nlohmann::json::parse(R"({
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

TEST(AccountingFile, TellsALaterServerWhatWasStored) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadAccountBefore(folder.path()).stored_steps, 0u);
  SessionLedger table(4);
  table.Add(1, 1'700'000'000'000'000'001);
  table.Update(0, {.actor = 1,
                   .session = 1'700'000'000'000'000'001,
                   .highest = 20,
                   .rejected = 1,
                   .after_gap = 2,
                   .lost = 3,
                   .duplicates = 4});
  ReplaceFile(folder.path() / kAccountingFile,
              AccountingJson(table, {.stored_steps = 1234, .stored_records = 1250}));
  const AccountBefore before = ReadAccountBefore(folder.path());
  EXPECT_EQ(before.stored_steps, 1234u);
  ASSERT_EQ(before.sessions.size(), 1u);
  EXPECT_EQ(before.sessions[0], table.at(0));
  EXPECT_FALSE(before.ring_replaced);
  for (const char* damaged :
       {"", "{", "{}", R"({"schema": "shoal-accounting-2"})", R"({"schema": "shoal-accounting-1"})",
        R"({"schema": "shoal-accounting-1", "stored_steps": -1})",
        R"({"schema": "shoal-accounting-1", "stored_steps": 1, "sessions": [{"actor": 1}]})",
        R"({"schema": "shoal-accounting-1", "stored_steps": 1, "sessions": [{"actor": 1,
            "session": 1, "highest": 9, "stored": 8, "rejected": 0, "after_gap": 0, "lost": 0,
            "duplicates": 0}]})"}) {
    ReplaceFile(folder.path() / kAccountingFile, damaged);
    EXPECT_THROW(ReadAccountBefore(folder.path()), Error) << damaged;
  }
}

TEST(AccountingFile, IsReplacedAsAWhole) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "accounting.json";
  ReplaceFile(path, "a longer first content");
  ReplaceFile(path, "second");
  EXPECT_EQ(ReadFile(path), "second");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".new"));
}

TEST(AccountingFile, SaysWhereItCannotBeWritten) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "accounting.json";
  EXPECT_THROW(ReplaceFile(path, "x"), Error);
}

}  // namespace
}  // namespace shoal
