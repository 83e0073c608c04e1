// SPDX-License-Identifier: Apache-2.0
#include "launch/run/resumed_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/files.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ResumedRunTest : public testing::Test {
 protected:
  ResumedRunTest() {
    options_.run_dir = folder_.path();
    options_.resume = "a";
    options_.dry_run = true;
  }

  // Leaves a run that ended like this.
  void Leave(const std::string& exit, bool judged) const {
    const RunFolder folder = RunFolder::Create(folder_.path(), "a", /*overwrite=*/false);
    RunConfig config;
    config.spec = replay::TinySpec(1);
    WriteRunConfig(run_, config);
    RunMeta meta;
    meta.exit = exit;
    meta.env_steps = 500;
    if (judged) meta.final_return = 1;
    WriteRunMeta(run_, config.config, meta);
  }
  std::string Refusal() const {
    return UsageMessage([this] { ResolveResumed(options_); });
  }

  TemporaryFolder folder_;
  const std::filesystem::path run_ = folder_.path() / "a";
  TrainOptions options_;
};

TEST_F(ResumedRunTest, ARunThatDoesNotExistIsRefused) { EXPECT_THAT(Refusal(), HasSubstr("'a'")); }

TEST_F(ResumedRunTest, ARunThatIsHeldIsRefused) {
  Leave("interrupted", /*judged=*/false);
  const RunFolder held = RunFolder::Reopen(folder_.path(), "a");
  EXPECT_THAT(ErrorMessage([this] { ResolveResumed(options_); }), HasSubstr("running"));
}

TEST_F(ResumedRunTest, AFinishedRunIsRefusedAndSaysHowToGoOn) {
  Leave("budget", /*judged=*/true);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("is finished (budget at 500 env steps)"),
                               HasSubstr("--set env_steps=N")));
}

TEST_F(ResumedRunTest, ARunWithoutItsConfigurationIsRefused) {
  Leave("interrupted", /*judged=*/false);
  WriteFileAtomically(run_ / kConfigFile, "{");
  EXPECT_THAT(Refusal(), HasSubstr("restore it from a copy"));
}

TEST_F(ResumedRunTest, OptionsOfAFreshRunAreRefused) {
  Leave("interrupted", /*judged=*/false);
  options_.preset = "fetch-reach-state";
  EXPECT_THAT(Refusal(), HasSubstr("no --preset"));
}

TEST_F(ResumedRunTest, KnowsHowTheRunWasSecured) {
  Leave("interrupted", /*judged=*/false);
  EXPECT_EQ(FormerSecurity(run_), "") << "killed before it was started";
  WriteClusterAddress(run_, {.domain = 4, .tag = "t", .secure = "/keys"});
  EXPECT_EQ(FormerSecurity(run_), "/keys");
  WriteFileAtomically(run_ / kClusterFile, "{");
  EXPECT_THAT(UsageMessage([this] { FormerSecurity(run_); }), HasSubstr("give --secure FOLDER"));
}

}  // namespace
}  // namespace shoal::launch
