// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/ring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <optional>

#include "common/base/files.h"
#include "common/base/random.h"
#include "replay_server/core/intake.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr uint64_t kCapacity = 16;

class RingTest : public testing::Test {
 protected:
  RingOptions Options() { return {.file = file_, .capacity = kCapacity, .run = "ring-test"}; }

  // A ring file with the script's first `records` records; returns how many were stored.
  uint64_t WriteRing(uint32_t records) {
    Ring ring(spec_, Options());
    SessionTable sessions(ring.sessions());
    EpisodeIndex index(ring, {});
    Intake intake(spec_.Hash(), &ring, &sessions, &index);
    intake.Take(script_.Chunk(1, records));
    return ring.last_id();
  }

  // The error message of all functions that read the file at start; "" if none refuses the file.
  std::string Refusal(const ObservationSpec& spec, const RingOptions& options) {
    return ErrorMessage([&] {
      Ring ring(spec, options);
      SessionTable sessions(ring.sessions());
      EpisodeIndex index(ring, {});
      Intake intake(spec.Hash(), &ring, &sessions, &index);
    });
  }
  std::string Refusal() { return Refusal(spec_, Options()); }

  void FlipBit(uint64_t offset) {
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    const char byte = static_cast<char>(file.get());
    file.seekp(static_cast<std::streamoff>(offset));
    file.put(static_cast<char>(byte ^ 4));
  }

  // Signs of life while the ring and its index are opened.
  int SignsOfLife() {
    int signs = 0;
    RingOptions options = Options();
    options.progress = [&signs] { ++signs; };
    const Ring ring(spec_, options);
    const EpisodeIndex index(ring, {}, options.progress);
    return signs;
  }

  const ObservationSpec spec_ = TinySpec(1);
  const RingGeometry geometry_{spec_, kCapacity};
  TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "replay.ring";
  RecordScript script_{spec_, 0, 10};
};

TEST_F(RingTest, SaysThatItIsAliveForEachRecordThatIsReadAtStart) {
  EXPECT_EQ(SignsOfLife(), 0) << "a new ring";
  const auto records = static_cast<int>(WriteRing(8));
  EXPECT_EQ(SignsOfLife(), 2 * static_cast<int>(kCapacity) + records);
}

TEST_F(RingTest, TheFileFollowsTheUmaskAndIsFullyReserved) {
  const mode_t former = umask(027);
  Ring ring(spec_, Options());
  umask(former);
  struct stat status {};
  ASSERT_EQ(stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(static_cast<uint64_t>(status.st_size), geometry_.total_bytes());
  EXPECT_GE(static_cast<uint64_t>(status.st_blocks) * 512, geometry_.total_bytes());
  EXPECT_FALSE(fs::exists(file_.string() + ".new"));
}

TEST_F(RingTest, KeepsTheNewestRecordsAndForgetsTheOldest) {
  Ring ring(spec_, Options());
  for (uint32_t i = 1; i <= 40; ++i) {
    const auto record = MakeRecord(spec_, 0, 0, 0, i, i);
    ASSERT_EQ(ring.Append(0, 1, 0, record.data()), i);
    EXPECT_EQ(ring.oldest_id(), i > kCapacity ? i - kCapacity + 1 : 1);
  }
  EXPECT_EQ(ring.stored_steps(), 40u);
  for (uint64_t id = 25; id <= 40; ++id) EXPECT_EQ(ring.Header(id).sequence, id);
  EXPECT_FALSE(ring.Holds(24));
  EXPECT_FALSE(ring.Holds(41));
}

TEST_F(RingTest, AReopenedFileHoldsWhatWasStored) {
  for (const uint32_t records : {0u, 1u, 15u, 16u, 17u, 50u}) {
    fs::remove(file_);
    const uint64_t stored = WriteRing(records);
    uint64_t steps = 0;
    Ring ring(spec_, Options());
    EXPECT_EQ(ring.last_id(), stored);
    EXPECT_EQ(ring.oldest_id(), stored > kCapacity ? stored - kCapacity + 1 : 1);
    for (uint64_t sequence = 1; sequence <= records; ++sequence) {
      steps += RecordLayout::Header(script_.At(sequence).data()).index > 0 ? 1 : 0;
    }
    EXPECT_EQ(ring.stored_steps(), steps);
    const auto bytes = static_cast<size_t>(ring.layout().record_bytes());
    for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
      const uint8_t* record = ring.Record(id);
      EXPECT_EQ(std::vector<uint8_t>(record, record + bytes), script_.At(id));
    }
  }
}

TEST_F(RingTest, ASlotThatWasBeingOverwrittenIsLeftOut) {
  WriteRing(50);
  // State after a writer that died inside Append of record 51: its slot's commit word is 0.
  const uint64_t slot = geometry_.slots_offset() + 51 % kCapacity * geometry_.slot_bytes();
  std::fstream(file_, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(slot))
      .write("\0\0\0\0\0\0\0\0garbage", 15);
  Ring ring(spec_, Options());
  EXPECT_EQ(ring.last_id(), 50u);
  EXPECT_EQ(ring.oldest_id(), 36u);
  EXPECT_EQ(Refusal(),
            "the replay file '" + file_.string() + "' is in use by another replay server");
}

TEST_F(RingTest, IsOpenForOneWriterAtATime) {
  Ring first(spec_, Options());
  EXPECT_THAT(Refusal(), HasSubstr("in use by another"));
}

TEST_F(RingTest, RefusesAFileOfAnotherSpecCapacityOrVersion) {
  WriteRing(20);
  ObservationSpec other = spec_;
  other.task = "Other";
  EXPECT_THAT(Refusal(other, Options()),
              HasSubstr(fmt::format("{:016x}, this run has {:016x}", spec_.Hash(), other.Hash())));
  RingOptions larger = Options();
  larger.capacity = 17;
  EXPECT_THAT(Refusal(spec_, larger), HasSubstr("room for 16 records, replay.capacity is 17"));
  FlipBit(offsetof(RingHeader, version));
  EXPECT_THAT(Refusal(), HasSubstr("version 7, this program reads version 3"));
}

TEST_F(RingTest, RefusesTruncatedFilesAndGarbage) {
  WriteRing(20);
  for (const uint64_t bytes :
       {geometry_.total_bytes() - 1, geometry_.slots_offset(), uint64_t{100}}) {
    fs::resize_file(file_, bytes);
    EXPECT_THAT(Refusal(), HasSubstr("truncated")) << bytes;
  }
  fs::resize_file(file_, 0);
  EXPECT_THAT(Refusal(), HasSubstr("is empty"));
  WriteFileAtomically(file_, std::string(geometry_.total_bytes(), 'x'));
  EXPECT_THAT(Refusal(), HasSubstr("is not a replay file"));
}

TEST_F(RingTest, RefusesAFileWithAFlippedBitAnywhereInItsRecords) {
  WriteRing(20);
  const std::string intact = ReadFile(file_);
  ASSERT_EQ(Refusal(), "");
  std::vector<uint64_t> offsets;
  for (uint64_t i = 0; i < sizeof(RingHeader); i += 5) offsets.push_back(i);
  for (uint64_t slot = 0; slot < kCapacity; ++slot) {
    const uint64_t start = geometry_.slots_offset() + slot * geometry_.slot_bytes();
    for (uint64_t i = 0; i < sizeof(SlotHeader) + geometry_.record_bytes; i += 13) {
      offsets.push_back(start + i);
    }
  }
  for (const uint64_t offset : offsets) {
    FlipBit(offset);
    EXPECT_NE(Refusal(), "") << "bit at byte " << offset;
    FlipBit(offset);
  }
  ASSERT_EQ(ReadFile(file_), intact);
}

TEST_F(RingTest, RefusesSessionsThatDoNotAddUpToTheRing) {
  WriteRing(20);
  // Both copies of the only session: whichever counts is damaged.
  FlipBit(kRingHeaderBytes + offsetof(SessionCopy, highest));
  FlipBit(kRingHeaderBytes + sizeof(SessionCopy) + offsetof(SessionCopy, highest));
  EXPECT_THAT(Refusal(), HasSubstr("damaged"));
}

TEST_F(RingTest, ASnapshotSeesWhatAWriterHasStored) {
  Ring writer(spec_, Options());
  for (uint32_t i = 1; i <= 12; ++i) {
    writer.Append(0, 1, 0, MakeRecord(spec_, 0, 0, 0, i, i).data());
  }
  const Ring snapshot = Ring::OpenSnapshot(spec_, file_);
  EXPECT_EQ(snapshot.last_id(), 12u);
  EXPECT_TRUE(snapshot.Intact(1));
  for (uint32_t i = 13; i <= 17; ++i) {
    writer.Append(0, 1, 0, MakeRecord(spec_, 0, 0, 0, i, i).data());
  }
  EXPECT_FALSE(snapshot.Intact(1)) << "record 17 lies there now";
  EXPECT_TRUE(snapshot.Intact(2));
}

TEST_F(RingTest, ALimitOnFileSizeIsAClearErrorAndLeavesNothing) {
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit small = {100'000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string refusal = Refusal();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_THAT(refusal, HasSubstr("ulimit -f"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RingTest, AFullDiskIsAClearErrorAndLeavesNothing) {
  RingOptions options = Options();
  options.capacity = uint64_t{1} << 40;
  const std::string refusal = Refusal(spec_, options);
  EXPECT_THAT(refusal, HasSubstr("lower replay.capacity"));
  EXPECT_THAT(refusal, HasSubstr("MB are free in '" + folder_.path().string()));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RingTest, MoreMemoryThanThereIsIsAClearError) {
  const RingOptions options = {.file = {}, .capacity = uint64_t{1} << 40, .run = ""};
  EXPECT_THAT(Refusal(spec_, options), HasSubstr("set replay.storage=file"));
}

TEST_F(RingTest, InMemoryTheCountOfStepsGoesOnWhereEarlierServersWere) {
  Ring ring(spec_, {.file = {}, .capacity = kCapacity, .run = "", .steps_before = 500});
  EXPECT_EQ(ring.stored_steps(), 500u);
  EXPECT_EQ(ring.last_id(), 0u) << "the records are gone";
  const auto record = MakeRecord(spec_, 0, 0, 0, 1, 1);
  ring.Append(0, 1, 0, record.data());
  EXPECT_EQ(ring.stored_steps(), 501u);
}

TEST_F(RingTest, ANewFileCountsStepsOnFromThoseOfALostOne) {
  RingOptions options = Options();
  options.steps_before = 500;
  { EXPECT_EQ(Ring(spec_, options).stored_steps(), 500u); }
  // A server that was killed before it had stored anything leaves an empty ring.
  {
    Ring ring(spec_, options);
    EXPECT_EQ(ring.stored_steps(), 500u);
    const auto record = MakeRecord(spec_, 0, 0, 0, 1, 1);
    ring.Append(0, 1, 0, record.data());
  }
  options.steps_before = 0;
  EXPECT_EQ(Ring(spec_, options).stored_steps(), 501u) << "the ring itself knows from here on";
  options.steps_before = 900;
  EXPECT_EQ(Ring(spec_, options).stored_steps(), 900u) << "the file is an older copy";
}

TEST_F(RingTest, AFolderThatIsNotThereIsAClearError) {
  RingOptions options = Options();
  options.file = folder_.path() / "missing" / "replay.ring";
  EXPECT_THAT(Refusal(spec_, options), HasSubstr(folder_.path().string()));
}

TEST_F(RingTest, AnUnfinishedNewFileIsReplaced) {
  WriteFileAtomically(file_.string() + ".new", "left by a killed process");
  EXPECT_EQ(WriteRing(3), 3u);
  EXPECT_FALSE(fs::exists(file_.string() + ".new"));
}

}  // namespace
}  // namespace shoal::replay
