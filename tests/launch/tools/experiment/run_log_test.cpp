// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_log.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

TEST(RunLog, RemembersTheLastStartAndItsEnd) {
  const TemporaryFolder folder;
  const RunLog log(folder.path() / "runs.jsonl");
  EXPECT_TRUE(log.Read().empty());
  log.Write(RunStart{.run = "a", .jobs = 2, .cores = {0}});
  log.Write(RunEnding{.run = "a", .code = 2, .problem = "no \"camera\" \xff"});
  log.Write(RunStart{.run = "b"});
  auto runs = log.Read();
  ASSERT_TRUE(runs["a"].ending);
  EXPECT_EQ(runs["a"].ending->code, 2);
  EXPECT_FALSE(runs["b"].ending) << "it goes on, or died with us";
  log.Write(RunStart{.run = "a", .resumed = true});
  runs = log.Read();
  EXPECT_FALSE(runs["a"].ending) << "of a former start";
  EXPECT_EQ(runs["a"].starts, 2);
  EXPECT_EQ(runs["a"].most_jobs, 2) << "of any start";
}

TEST(RunLog, ALineCutShortCostsThatLineAlone) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "runs.jsonl";
  const RunLog log(file);
  log.Write(RunStart{.run = "a"});
  std::ofstream(file, std::ios::app) << "{\"event\": \"sta";
  EXPECT_EQ(log.Read().size(), 1u);
  log.Write(RunStart{.run = "b"});
  EXPECT_EQ(log.Read().size(), 2u) << "it must not swallow the next one";
}

TEST(RunLog, AnythingElseIsRefusedByLine) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "runs.jsonl";
  const RunLog log(file);
  log.Write(RunStart{.run = "a"});
  std::ofstream(file, std::ios::app) << "{\"event\": \"started\", \"run\": \"b\"}\n";
  try {
    log.Read();
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("line 2"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace shoal::launch
