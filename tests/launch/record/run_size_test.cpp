// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_size.h"

#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

TEST(RunSize, CountsEachFileOnceByItsBlocks) {
  const TemporaryFolder run;
  EXPECT_EQ(SizeOfRun(run.path() / "absent").total, 0u);
  MakeFolders(run.path() / "checkpoints" / "best");
  const RunSize before = SizeOfRun(run.path());
  WriteFileAtomically(run.path() / "checkpoints" / "x", std::string(1'000'000, 'x'));
  std::filesystem::create_hard_link(run.path() / "checkpoints" / "x",
                                    run.path() / "checkpoints" / "best" / "x");
  WriteFileAtomically(run.path() / "sparse", "");
  std::filesystem::resize_file(run.path() / "sparse", 1'000'000'000);
  const RunSize size = SizeOfRun(run.path());
  EXPECT_GE(size.total - before.total, 1'000'000u);
  EXPECT_LT(size.total - before.total, 1'100'000u);
  EXPECT_EQ(size.replay, 0u);
}

TEST(RunSize, IsShortForPeople) {
  EXPECT_EQ(FormatBytes(0), "0.0 MB");
  EXPECT_EQ(FormatBytes(420'000), "0.4 MB");
  EXPECT_EQ(FormatBytes(13'200'000), "13 MB");
  EXPECT_EQ(FormatBytes(2'140'000'000), "2.1 GB");
}

}  // namespace
}  // namespace shoal::launch
