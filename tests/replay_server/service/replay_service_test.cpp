// SPDX-License-Identifier: Apache-2.0
// shoal-replay as a process, over DDS.
#include "replay_server/service/replay_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/aligned_bytes.h"
#include "common/config/batch_options.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/batch_slots.h"
#include "replay_server/core/replay_core.h"
#include "tests/replay_server/service/replay_peers.h"
#include "tests/replay_server/service/replay_process.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

class ReplayServiceTest : public testing::Test {
 protected:
  ReplayServiceTest() : run_(TinyRun(2, 4000)) {
    run_.spec = TinySpec(2, 60, 70);
    run_.config.replay.storage = "file";
    run_.config.learner.batch = 128;  // 8 MB: several parts
    run_.config.actors = 2;
    dds::ClaimDomain(run_.config.transport, &address_);
    WriteRunConfig(folder_.path(), run_);
    WriteClusterAddress(folder_.path(), address_);
  }

  void StartReplay() {
    replay_.emplace(std::vector<std::string>{"--run", folder_.path()}, folder_.path() / "err");
  }
  void StartAll() {
    StartReplay();
    peers_.emplace(run_, address_);
    ASSERT_TRUE(peers_->WaitForReplay()) << replay_->Errors();
  }
  // Stops the replay as the coordinator does.
  void StopReplay() {
    peers_->Stop();
    EXPECT_EQ(replay_->ExitCode(seconds(20)), 0) << replay_->Errors();
  }
  // The accounting of an actor's session; null when there is none.
  nlohmann::json Accounting(const RecordScript& script) {
    const auto object = nlohmann::json::parse(ReadFile(folder_.path() / "accounting.json"));
    for (const auto& session : object.at("sessions")) {
      if (session.at("actor") == script.actor() && session.at("session") == script.session()) {
        return session;
      }
    }
    return nullptr;
  }
  // Every frame of the batch is one of the script's.
  void ExpectFramesOf(RecordScript* script, uint64_t records, std::vector<uint8_t> batch) {
    const RecordLayout layout(run_.spec);
    std::set<uint64_t> frames;  // hashes
    for (uint64_t sequence = 1; sequence <= records; ++sequence) {
      const auto frame = layout.Frame(script->At(sequence).data());
      frames.insert(HashBytes(frame.data(), frame.size()));
    }
    const BatchSchema schema = BatchSchemaOf(run_);
    ASSERT_EQ(batch.size(), schema.total_bytes());
    const AlignedBytes memory(batch.size());
    std::memcpy(memory.data(), batch.data(), batch.size());
    const BatchView view = schema.View(memory.data());
    const size_t frame_bytes = static_cast<size_t>(layout.frame_bytes());
    for (const auto& stacks : {view.obs_frames, view.next_obs_frames}) {
      for (size_t offset = 0; offset < stacks.size(); offset += frame_bytes) {
        const auto frame = stacks.subspan(offset, frame_bytes);
        ASSERT_TRUE(frames.contains(HashBytes(frame.data(), frame.size()))) << "at byte " << offset;
      }
    }
  }

  // The newest frames of each sample are those of the records of `script` that its id names. The
  // script has one environment, so a record follows the last.
  void ExpectFramesOfTheirIds(RecordScript* script, const BatchSlot& slot) {
    const BatchSchema schema = BatchSchemaOf(run_);
    const SlotReader reader(slot.address, slot.learner_session, schema.total_bytes());
    const BatchView view = schema.View(reader.Batch(slot.slot, slot.request));
    const RecordLayout layout(run_.spec);
    const auto frame_bytes = static_cast<size_t>(layout.frame_bytes());
    const auto shows = [&](std::span<const uint8_t> stacks, size_t element, uint64_t sequence) {
      const size_t newest = 2 * element + 1;
      const std::vector<uint8_t>& record = script->At(sequence);
      return std::ranges::equal(stacks.subspan(newest * frame_bytes, frame_bytes),
                                layout.Frame(record.data()));
    };
    for (size_t b = 0; b < view.id.size(); ++b) {
      ASSERT_TRUE(shows(view.obs_frames, b, view.id[b] - 1)) << "before record " << view.id[b];
      ASSERT_TRUE(shows(view.next_obs_frames, b, view.id[b])) << "record " << view.id[b];
    }
  }

  RunConfig run_;
  ClusterAddress address_;
  TemporaryFolder folder_;
  std::optional<ReplayProcess> replay_;
  std::optional<ReplayPeers> peers_;
  RecordScript a_{TinySpec(2, 60, 70), 0, 10}, b_{TinySpec(2, 60, 70), 1, 11};
};

TEST_F(ReplayServiceTest, LeavesForGoodWithOneLineWhenNoSessionFitsTheTableAnyMore) {
  {
    Ring ring(run_.spec, {.file = folder_.path() / kRingFile, .capacity = 4000, .run = "tiny"});
    SessionTable sessions(ring.sessions());
    for (uint32_t actor = 1; actor <= kMaxSessions; ++actor) sessions.Add(actor, 1);
  }
  StartAll();
  ASSERT_TRUE(peers_->Write(a_.Chunk(1, 1)));
  // Long before it would miss the heartbeat.
  EXPECT_EQ(replay_->ExitCode(seconds(8)), 2) << replay_->Errors();
  EXPECT_THAT(replay_->Errors(), HasSubstr("can count 4096 actor sessions"));
}

TEST_F(ReplayServiceTest, StoresAcknowledgesAnswersAndAccounts) {
  StartAll();
  ASSERT_TRUE(peers_->Deliver(&a_, 400)) << replay_->Errors();
  EXPECT_GT(peers_->LastCredit(0).allowed, 400u);
  const auto batch = peers_->Batch(1);
  ASSERT_FALSE(batch.empty());
  ExpectFramesOf(&a_, 400, batch);
  EXPECT_EQ(peers_->Batch(1), batch) << "a repeated request";
  EXPECT_TRUE(peers_->WaitFor([&] {
    const auto& metrics = peers_->MetricsLocked();
    return metrics.contains("stored_records") && metrics.at("stored_records") == 400 &&
           metrics.at("sampled") == 128 && metrics.at("repeated_batches") == 1;
  }));
  StopReplay();
  EXPECT_EQ(Accounting(a_).at("highest"), 400u);
  EXPECT_EQ(Accounting(a_).at("stored"), 400u);
}

TEST_F(ReplayServiceTest, CopiesWithTheThreadsThatTheRunAsksFor) {
  run_.config.replay.threads = 3;
  WriteRunConfig(folder_.path(), run_);
  StartAll();
  ASSERT_TRUE(peers_->Deliver(&a_, 400)) << replay_->Errors();
  ExpectFramesOf(&a_, 400, peers_->Batch(1));
  EXPECT_TRUE(peers_->WaitFor([&] {
    const auto& metrics = peers_->MetricsLocked();
    return metrics.contains("sampled") && metrics.at("sampled") == 128 &&
           metrics.at("gather_threads") == 3;
  }));
  StopReplay();
}

// Records are stored while threads copy, and overwrite the oldest records of a small ring.
TEST_F(ReplayServiceTest, CopiesNoRecordThatIsOverwrittenMeanwhile) {
  run_.config.replay.threads = 3;
  run_.config.replay.capacity = 150;
  run_.config.transport.chunk_records = 24;
  WriteRunConfig(folder_.path(), run_);
  StartAll();
  RecordScript script(run_.spec, 0, 10, /*envs=*/1);
  uint64_t stored = 150;
  ASSERT_TRUE(peers_->Deliver(&script, stored)) << replay_->Errors();
  for (uint64_t request = 1; request <= 60; request += 3) {
    for (uint64_t i = 0; i < 6; ++i) peers_->RequestSlot(request + i / 2, request - 1);  // twice
    ASSERT_TRUE(peers_->Deliver(&script, stored += 60)) << replay_->Errors();
    for (uint64_t i = 0; i < 3; ++i) {
      const std::optional<BatchSlot> slot = peers_->WaitForSlot(request + i);
      ASSERT_TRUE(slot) << replay_->Errors();
      ASSERT_NO_FATAL_FAILURE(ExpectFramesOfTheirIds(&script, *slot));
    }
  }
  StopReplay();
}

TEST_F(ReplayServiceTest, NothingAcknowledgedIsLostWhenKilledAndRestarted) {
  StartAll();
  for (uint64_t target = 200; target <= 800; target += 200) {
    ASSERT_TRUE(peers_->Deliver(&a_, target)) << replay_->Errors();
    ASSERT_TRUE(peers_->Deliver(&b_, target)) << replay_->Errors();
    replay_->Kill();
    StartReplay();
  }
  ASSERT_TRUE(peers_->Deliver(&a_, 900)) << replay_->Errors();
  StopReplay();
  for (RecordScript* script : {&a_, &b_}) {
    const uint64_t records = script == &a_ ? 900 : 800;
    EXPECT_EQ(Accounting(*script).at("highest"), records);
    EXPECT_EQ(Accounting(*script).at("stored"), records) << "no episode was cut by the restarts";
  }
  const ReplayCore core(run_, folder_.path(), 1);
  EXPECT_EQ(core.ring().last_id(), 1700u);
}

TEST_F(ReplayServiceTest, HandsOutTheSameBatchAfterARestart) {
  StartAll();
  ASSERT_TRUE(peers_->Deliver(&a_, 100));
  const auto batch = peers_->Batch(3);
  ASSERT_FALSE(batch.empty());
  replay_->Kill();
  StartReplay();
  EXPECT_EQ(peers_->Batch(3), batch);
}

TEST_F(ReplayServiceTest, TellsAnActorOfAnotherSpec) {
  StartAll();
  TransitionChunk chunk = a_.Chunk(1, 2);
  chunk.spec_hash ^= 1;
  peers_->Write(chunk);
  EXPECT_TRUE(peers_->WaitFor([&] { return peers_->CreditLocked(0).session == 10; }));
  EXPECT_EQ(peers_->LastCredit(0).spec_hash, run_.spec.Hash());
  EXPECT_EQ(peers_->LastCredit(0).allowed, 0u);
  StopReplay();
  EXPECT_EQ(Accounting(a_), nullptr);
}

TEST_F(ReplayServiceTest, LeavesItsAccountingOnSigterm) {
  StartAll();
  ASSERT_TRUE(peers_->Deliver(&a_, 50));
  replay_->Signal(SIGTERM);
  EXPECT_EQ(replay_->ExitCode(seconds(20)), 128 + SIGTERM) << replay_->Errors();
  EXPECT_EQ(Accounting(a_).at("stored"), 50u);
}

TEST_F(ReplayServiceTest, ASecondServerIsRefused) {
  StartAll();
  ReplayProcess second({"--run", folder_.path()}, folder_.path() / "err2");
  EXPECT_EQ(second.ExitCode(seconds(20)), 1);
  EXPECT_THAT(second.Errors(), HasSubstr("is taken: another process is the replay of DDS domain"));
}

TEST_F(ReplayServiceTest, BadUsageAndBadFilesAreOneLine) {
  ReplayProcess usage({"--nonsense"}, folder_.path() / "err1");
  EXPECT_EQ(usage.ExitCode(seconds(20)), 2);
  ReplayProcess folder({"--run", folder_.path() / "missing"}, folder_.path() / "err2");
  EXPECT_EQ(folder.ExitCode(seconds(20)), 1);
  EXPECT_THAT(folder.Errors(), HasSubstr("missing"));
  WriteFileAtomically(folder_.path() / kRingFile, "not a ring");
  ReplayProcess ring({"--run", folder_.path()}, folder_.path() / "err3");
  EXPECT_EQ(ring.ExitCode(seconds(20)), 2);
  EXPECT_THAT(ring.Errors(), HasSubstr("replay.ring"));
  for (ReplayProcess* process : {&usage, &folder, &ring}) {
    EXPECT_EQ(std::ranges::count(process->Errors(), '\n'), 1) << process->Errors();
  }
}

// Takes the lease of 10 seconds.
TEST_F(ReplayServiceTest, LeavesWithAnErrorWhenTheCoordinatorIsGoneButStoresWhatStillComes) {
  StartAll();
  ASSERT_TRUE(peers_->Deliver(&a_, 50));
  peers_->silent = true;
  const SteadyTime start = Now();
  while (replay_->Errors().find("coordinator is gone") == std::string::npos) {
    ASSERT_LT(Now() - start, seconds(30));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // a poll with a deadline
  }
  EXPECT_TRUE(peers_->Deliver(&a_, 90)) << "the actors' last records";
  EXPECT_EQ(replay_->ExitCode(seconds(30)), 1);
  EXPECT_EQ(Accounting(a_).at("stored"), 90u);
}

}  // namespace
}  // namespace shoal::replay
