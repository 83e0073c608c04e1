// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "actor/sending/sequence_log.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/session_number.h"
#include "common/run_folder/accounting_file.h"
#include "common/run_folder/run_file_names.h"
#include "common/run_folder/update_page.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/intake.h"
#include "replay_server/core/ring.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr uint64_t kRecords = 40, kSession = 10;

// A run of one actor that stored kRecords records.
class RunCheckTest : public ::testing::Test {
 protected:
  RunCheckTest() {
    config_.spec = replay::TinySpec(1);
    config_.config.replay.capacity = 64;
    config_.config.replay.min_size = 8;
    config_.config.envs_per_actor = 4;
    MakeFolders(run_ / kEvaluationFolder);
    replay::RecordScript script(config_.spec, 0, kSession);
    replay::Ring ring(config_.spec, {.file = run_ / kRingFile, .capacity = 64, .run = "r"});
    replay::SessionTable sessions(ring.sessions());
    replay::EpisodeIndex index(ring, {});
    replay::Intake intake(config_.spec.Hash(), &ring, &sessions, &index);
    intake.Take(script.Chunk(1, kRecords));
    account_ = {.stored_steps = ring.stored_steps(),
                .stored_records = ring.last_id(),
                .sessions = sessions.all()};
    StoreAccount(run_, account_);
    actor::SequenceLog page(run_, 0, kSession, 0, 4);
    while (page.CountRecord() < kRecords + 2) {
    }
    UpdatePage(run_, 0).SetDone(100);
    NextSession(run_, "learner-0", 7);
    meta_.env_steps = ring.stored_steps();
    meta_.updates = 100;
    meta_.updates_lost = 5;
    WriteRunMeta(run_, config_.config, meta_);
    WriteCheckpoint(100);
  }

  void WriteCheckpoint(uint64_t updates) const {
    WriteCheckpointFiles(run_ / kCheckpointFolder,
                         {.state = {.updates = updates,
                                    .env_steps = updates,
                                    .spec_hash = config_.spec.Hash(),
                                    .precision = "f32"},
                          .learner = "learner",
                          .policy = "policy",
                          .description = {}},
                         {});
  }
  RunCheck Check() const { return CheckRunFiles(run_, config_, meta_, /*own_actors=*/1); }
  // Carries out what is to be repaired, after which nothing is left to do. The lines.
  std::vector<std::string> Mend() const {
    const RunCheck check = Check();
    for (const auto& repair : check.repairs) repair();
    EXPECT_THAT(Check().repairs, IsEmpty());
    return check.lines;
  }
  // The refusal; empty where there is none or its exit code is another one.
  std::string Refusal(const std::function<void()>& look) const {
    try {
      look();
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2) << e.what();
      return e.what();
    }
    return "";
  }
  std::string Refusal() const {
    return Refusal([this] { Check(); });
  }

  const TemporaryFolder folder_;
  const fs::path run_ = folder_.path();
  const fs::path page_ = run_ / kMadeFolder / "actor-0-10.page";
  RunConfig config_;
  RunMeta meta_;
  RunAccount account_;
};

TEST_F(RunCheckTest, AWholeRunNeedsNothing) {
  EXPECT_THAT(Check().lines, IsEmpty());
  EXPECT_THAT(Check().repairs, IsEmpty());
}

TEST_F(RunCheckTest, WithoutItsRingTheRunSaysSoAndCountsOn) {
  fs::remove(run_ / kRingFile);
  EXPECT_THAT(Mend(), ElementsAre(AllOf(HasSubstr("replay starts empty, env steps continue from " +
                                                  std::to_string(meta_.env_steps)),
                                        HasSubstr("8 sampleable transitions"))));
  meta_.env_steps += 9;  // the account of a killed replay is up to a second old
  Mend();
  EXPECT_EQ(ReadAccount(run_).stored_steps, meta_.env_steps);
  EXPECT_EQ(ReadAccount(run_).sessions, account_.sessions);
}

TEST_F(RunCheckTest, ARunWhoseReplayWasInMemorySaysThatItIsRefilled) {
  config_.config.replay.storage = "memory";
  fs::remove(run_ / kRingFile);
  EXPECT_THAT(Check().lines,
              ElementsAre(AllOf(HasSubstr("replay.storage=memory: the stored records are lost"),
                                HasSubstr("8 sampleable transitions"))));
}

TEST_F(RunCheckTest, ARingThatCannotBeUsedIsRefusedWithTheRemedy) {
  const auto refused = [&](const std::string& why) {
    return AllOf(HasSubstr(kRingFile), HasSubstr(why), HasSubstr("remove it, and the run goes on"));
  };
  config_.config.replay.capacity = 128;
  EXPECT_THAT(Refusal(), refused("has room for 64 records, replay.capacity is 128"));
  config_.config.replay.capacity = 64;
  fs::resize_file(run_ / kRingFile, fs::file_size(run_ / kRingFile) - 1);
  EXPECT_THAT(Refusal(), refused("truncated"));
  fs::resize_file(run_ / kRingFile, 56);
  EXPECT_THAT(Refusal(), refused("truncated"));
}

TEST_F(RunCheckTest, TheAccountIsRebuiltFromTheRing) {
  meta_.env_steps -= 9;  // the meta.json of a killed run is older than its ring
  for (const char* content : {"", "{", "{\"schema\": \"shoal-accounting-1\"}"}) {
    WriteFileAtomically(run_ / kAccountingFile, content);
    EXPECT_THAT(Mend(), ElementsAre(AllOf(HasSubstr("accounting.json' is damaged"),
                                          HasSubstr("from the replay's ring"))));
    const RunAccount rebuilt = ReadAccount(run_);
    EXPECT_EQ(rebuilt.sessions, account_.sessions);
    EXPECT_EQ(rebuilt.stored_steps, account_.stored_steps);
    EXPECT_EQ(rebuilt.stored_records, account_.stored_records);
  }
  fs::remove(run_ / kAccountingFile);
  EXPECT_THAT(Check().lines, IsEmpty()) << "the replay writes it from its ring";
}

TEST_F(RunCheckTest, WithoutTheRingTheAccountIsRebuiltFromTheActorsCounters) {
  fs::remove(run_ / kRingFile);
  fs::remove(run_ / kAccountingFile);
  EXPECT_THAT(Mend().at(1), AllOf(HasSubstr("accounting.json' is missing"),
                                  HasSubstr("what happened to 42 records is unknown")));
  const RunAccount rebuilt = ReadAccount(run_);
  EXPECT_EQ(rebuilt.stored_steps, meta_.env_steps);
  ASSERT_EQ(rebuilt.sessions.size(), 1u);
  EXPECT_EQ(rebuilt.sessions[0].lost, 42u);
}

TEST_F(RunCheckTest, ACounterPageIsRebuiltAndSaysWhatIsNoLongerKnown) {
  const auto rebuilt = [&](const std::string& state) {
    const auto lines = Mend();
    EXPECT_THAT(lines, ElementsAre(AllOf(HasSubstr("actor-0-10.page' is " + state),
                                         HasSubstr("made at least 40 records"))));
    const auto pages = actor::ReadSequenceLogs(run_);
    return pages.size() == 1 && pages[0].made == kRecords && pages[0].rebuilt;
  };
  fs::resize_file(page_, 44);
  EXPECT_TRUE(rebuilt("damaged"));
  fs::resize_file(page_, 0);
  EXPECT_TRUE(rebuilt("damaged"));
  fs::remove(page_);
  EXPECT_TRUE(rebuilt("missing"));
  std::string bytes = ReadFile(page_);
  bytes[32] = 3;  // of `made`: fewer than were stored
  WriteFileAtomically(page_, bytes);
  EXPECT_TRUE(rebuilt("damaged"));
}

TEST_F(RunCheckTest, CountsOfTheLearnerAndSessionNumbersAreRebuilt) {
  WriteFileAtomically(run_ / kUpdatePageFile, "torn");
  WriteFileAtomically(run_ / kSessionFolder / "learner-0", "12x");
  EXPECT_THAT(Mend(), ElementsAre(AllOf(HasSubstr("learner.page' is damaged"),
                                        HasSubstr("no longer known")),
                                  HasSubstr("sessions/learner-0' is damaged")));
  EXPECT_EQ(ReadLostUpdates(run_), 5u);
  EXPECT_EQ(NextSession(run_, "learner-0", 8), 8u);
}

TEST_F(RunCheckTest, AnOlderCheckpointStandsInForADamagedOne) {
  WriteCheckpoint(200);
  fs::resize_file(run_ / kCheckpointFolder / "step_000000200" / kLearnerFile, 3);
  EXPECT_THAT(Check().lines, ElementsAre(AllOf(HasSubstr("checkpoint refused"),
                                               HasSubstr("goes on from step_000000100"))));
  fs::resize_file(run_ / kCheckpointFolder / "step_000000100" / kLearnerFile, 3);
  EXPECT_THAT(Refusal(),
              AllOf(HasSubstr("none of 2 checkpoint(s)"), HasSubstr("away to train from scratch")));
}

TEST_F(RunCheckTest, WhatCannotBeDerivedIsRefusedWithTheRemedy) {
  const fs::path evaluation = run_ / kEvaluationFolder / "steps_0000000100_updates_0000000100.json";
  WriteFileAtomically(evaluation, "{");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr(evaluation.string()), HasSubstr("remove the file")));
  fs::remove(evaluation);
  const fs::path rollout = run_ / kMadeFolder / "actor-0.rollout";
  WriteFileAtomically(rollout, "{}");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr(rollout.string()), HasSubstr("remove it")));
}

TEST_F(RunCheckTest, MetaIsRebuiltWhereItIsMissingAndRefusedWhereItIsDamaged) {
  std::vector<std::string> lines;
  EXPECT_EQ(ReadMetaToGoOn(run_, &lines).env_steps, meta_.env_steps);
  EXPECT_THAT(lines, IsEmpty());
  for (const char* content : {"", "{", "{}", "[]"}) {
    WriteFileAtomically(run_ / kMetaFile, content);
    EXPECT_THAT(Refusal([&] { ReadMetaToGoOn(run_, &lines); }),
                AllOf(HasSubstr("meta.json"), HasSubstr("remove it")))
        << content;
  }
  fs::remove(run_ / kMetaFile);
  const RunMeta rebuilt = ReadMetaToGoOn(run_, &lines);
  EXPECT_EQ(rebuilt.updates, 100u);
  EXPECT_EQ(rebuilt.env_steps, 100u) << "the checkpoint's, which is beyond the account's";
  EXPECT_THAT(lines, ElementsAre(HasSubstr("at 100 env steps")));
}

// A process that opened one would wait for ever.
TEST_F(RunCheckTest, AFifoAnywhereInTheRunIsRefused) {
  EXPECT_EQ(Refusal([&] { CheckKindsOfFiles(run_); }), "");
  for (const char* name : {kMetricsFile, "made/actor-7-1.page", "logs.fifo"}) {
    ASSERT_EQ(mkfifo((run_ / name).c_str(), 0600), 0);
    EXPECT_THAT(Refusal([&] { CheckKindsOfFiles(run_); }),
                AllOf(HasSubstr((run_ / name).string()), HasSubstr("remove it")));
    fs::remove(run_ / name);
  }
}

}  // namespace
}  // namespace shoal::launch
