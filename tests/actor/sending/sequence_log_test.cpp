// SPDX-License-Identifier: Apache-2.0
#include "actor/sending/sequence_log.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "common/base/error.h"
#include "tests/support/temporary_folder.h"

namespace shoal::actor {
namespace {

TEST(SequenceLog, CountsFromOne) {
  const TemporaryFolder run;
  SequenceLog page(run.path(), 2, 10, 8, 4);
  EXPECT_EQ(page.CountRecord(), 1u);
  EXPECT_EQ(page.CountRecord(), 2u);
  const auto counts = ReadSequenceLogs(run.path());
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].actor, 2u);
  EXPECT_EQ(counts[0].session, 10u);
  EXPECT_EQ(counts[0].made, 2u);
}

TEST(SequenceLog, SurvivesSigkill) {
  const TemporaryFolder run;
  const pid_t child = fork();
  if (child == 0) {
    SequenceLog page(run.path(), 0, 10, 0, 1);
    for (int i = 0; i < 1000; ++i) page.CountRecord();
    page.TakeEpisode(0);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(ReadSequenceLogs(run.path()).at(0).made, 1000u);
}

TEST(SequenceLog, EpisodesGoOnAcrossSessionsAndActors) {
  const TemporaryFolder run;
  {
    SequenceLog first(run.path(), 0, 10, 0, 2);
    EXPECT_EQ(first.TakeEpisode(1), 0u);
    EXPECT_EQ(first.TakeEpisode(1), 1u);
  }
  SequenceLog again(run.path(), 0, 11, 0, 2);
  EXPECT_EQ(again.TakeEpisode(0), 0u);
  EXPECT_EQ(again.TakeEpisode(1), 2u);
  EXPECT_EQ(again.made(), 0u) << "sequences are per session";
  SequenceLog other(run.path(), 1, 12, 1, 2);  // hosts environments 1 and 2
  EXPECT_EQ(other.TakeEpisode(0), 3u);
  EXPECT_EQ(other.TakeEpisode(1), 0u);
}

TEST(SequenceLog, ABrokenPageIsRefusedByName) {
  const TemporaryFolder run;
  { SequenceLog page(run.path(), 0, 10, 0, 2); }
  std::filesystem::resize_file(run.path() / "made" / "actor-0-10.page", 44);
  try {
    ReadSequenceLogs(run.path());
    FAIL() << "a truncated page was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("actor-0-10.page"), std::string::npos) << e.what();
  }
}

TEST(SequenceLog, ADamagedPageIsRebuiltFromWhatTheReceiverSaw) {
  const TemporaryFolder run;
  { SequenceLog sound(run.path(), 1, 20, 2, 2); }
  uint32_t begun = 0;
  {
    SequenceLog page(run.path(), 0, 10, 0, 2);
    for (int i = 0; i < 30; ++i) page.CountRecord();
    for (int i = 0; i < 7; ++i) begun = page.TakeEpisode(1);
  }
  EXPECT_TRUE(FindDamagedPages(run.path()).empty());
  for (const int bytes : {0, 3, 44}) {
    std::filesystem::resize_file(run.path() / "made" / "actor-0-10.page", bytes);
    const auto damaged = FindDamagedPages(run.path());
    ASSERT_EQ(damaged.size(), 1u) << bytes;
    EXPECT_EQ(damaged[0].actor, 0u);
    EXPECT_EQ(damaged[0].session, 10u);
  }
  RebuildSequenceLog(run.path(), 0, 10, 2, 25);
  EXPECT_TRUE(FindDamagedPages(run.path()).empty());
  const auto counts = ReadSequenceLogs(run.path());
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_EQ(counts[0].made, 25u);
  EXPECT_TRUE(counts[0].rebuilt);
  EXPECT_FALSE(counts[1].rebuilt);
  SequenceLog next(run.path(), 0, 11, 0, 2);
  EXPECT_GT(next.TakeEpisode(1), begun) << "no episode is played twice";
}

TEST(SequenceLog, APageUnderAForeignNameIsRefused) {
  const TemporaryFolder run;
  { SequenceLog page(run.path(), 0, 10, 0, 2); }
  std::filesystem::rename(run.path() / "made" / "actor-0-10.page",
                          run.path() / "made" / "mine.page");
  EXPECT_THROW(FindDamagedPages(run.path()), Error);
}

}  // namespace
}  // namespace shoal::actor
