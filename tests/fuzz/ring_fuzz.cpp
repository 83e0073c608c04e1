// SPDX-License-Identifier: Apache-2.0
// Replay files: any bytes are refused with Error, or all operations of a server work on the ring.
// First byte: 0 = the rest is the unchanged file; otherwise the checksums of header, sessions and
// slots are corrected first, so that the input reaches the code after the checks. The file is cut
// or filled to the size in its header.
#include <cstddef>
#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/run_folder/run_file_names.h"
#include "replay_server/core/frame_check.h"
#include "replay_server/core/replay_core.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

constexpr int64_t kCapacity = 64;  // the least that a configuration may ask for

RunConfig Run() {
  RunConfig run = TinyRun(1, kCapacity);
  run.config.replay.storage = "file";
  return run;
}

template <class T>
T* At(std::string* file, uint64_t offset) {
  return reinterpret_cast<T*>(file->data() + offset);
}

// Input bytes are placed at the start of each part, so that a few bytes reach every part of a large
// file.
std::string FileWithFittingChecks(const std::string& bytes, const RunConfig& run) {
  const RingGeometry geometry(run.spec, static_cast<uint64_t>(kCapacity));
  std::string file(geometry.total_bytes(), '\0');
  const RingHeader header = MakeRingHeader(geometry, run.spec.Hash(), "fuzz");
  std::memcpy(file.data(), &header, sizeof header);
  Random filler(1);
  size_t at = 0;
  const auto take = [&](void* to, size_t size) {
    const size_t n = std::min(size, bytes.size() - at);
    std::memcpy(to, bytes.data() + at, n);
    at += n;
    return n > 0;
  };
  for (uint64_t i = 0; i < 2; ++i) {  // two sessions: a copy each
    SessionCopy& copy = At<StoredSession>(&file, kRingHeaderBytes)[i].copies[1];
    if (!take(&copy, sizeof copy)) break;
    const auto* content = reinterpret_cast<const uint8_t*>(&copy) + sizeof copy.check;
    copy.check = std::max<uint64_t>(1, HashBytes(content, sizeof copy - sizeof copy.check));
  }
  for (uint64_t slot = 0; slot < geometry.capacity; ++slot) {
    auto* stored = At<SlotHeader>(&file, geometry.slots_offset() + slot * geometry.slot_bytes());
    auto* record = reinterpret_cast<uint8_t*>(stored + 1);
    if (!take(stored, sizeof *stored) || !take(record, geometry.prefix_bytes)) break;
    stored->frame_check = FrameCheck(FrameOf(geometry, record));
    if (stored->commit != 0) stored->commit = SlotCommit(geometry, *stored, record);
  }
  return file;
}

void Use(const RunConfig& run) {
  ReplayCore core(run, fuzz::Scratch(), 9);
  const uint64_t before = core.ring().last_id();
  std::vector<uint64_t> batch(core.batch_schema().total_bytes() / 8 + 16);
  uint8_t* aligned = reinterpret_cast<uint8_t*>(batch.data());
  aligned += (64 - reinterpret_cast<uintptr_t>(aligned) % 64) % 64;
  core.TakeRequest({.spec_hash = run.spec.Hash(),
                    .learner_session = 1,
                    .request = 1,
                    .batch = static_cast<uint32_t>(run.config.learner.batch),
                    .schema_hash = core.batch_schema().Hash()});
  core.TryAnswer(aligned);
  RecordScript script(run.spec, 7, 3);
  for (uint32_t i = 0; i < 80; i += 4) core.TakeChunk(script.Chunk(i + 1, 4));
  CHECK(core.ring().last_id() == before + core.counters().intake.records);
  core.TryAnswer(aligned);
  core.TakeCredits(false);
}

}  // namespace
}  // namespace shoal::replay

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace shoal::replay;  // NOLINT: an entry point outside any namespace
  if (size == 0) return 0;
  static const shoal::RunConfig run = Run();
  const std::string bytes = shoal::fuzz::Text(data + 1, size - 1);
  shoal::fuzz::WriteScratch(shoal::fuzz::Scratch() / shoal::kRingFile,
                            data[0] == 0 ? bytes : FileWithFittingChecks(bytes, run));
  try {
    Use(run);
  } catch (const shoal::Error& e) {
    shoal::fuzz::CheckOneLine(e.what());
  }
  return 0;
}
