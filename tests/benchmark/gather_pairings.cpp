// SPDX-License-Identifier: Apache-2.0
// Drawing a batch from a ring, compared with a plain copy of the same number of random frames; from
// a large ring, compared with a small one; from a ring in a file, compared with one in memory.
#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>

#include "common/base/check.h"
#include "common/base/random.h"
#include "common/base/usable_cores.h"
#include "common/spec/record.h"
#include "launch/processes/scratch_folder.h"
#include "replay_server/core/batch_gather.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/uniform_selector.h"
#include "replay_server/service/gather_threads.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kBatch = 128, kPad = 4, kChannels = 3;
constexpr uint64_t kFew = 10'000, kMany = 200'000;
constexpr uint32_t kEpisodeSteps = 50, kDifferent = 64;
constexpr int kInserts = 16;  // per batch, as with replay.samples_per_insert = 8
constexpr double kCopyTarget = 0.8, kManyTarget = 0.8, kFileTarget = 0.95;
constexpr double kTwoThreadsTarget = 1.8;

// A full ring of one environment's episodes, and what draws batches from it.
class FullReplay {
 public:
  // `file`: empty = in memory.
  FullReplay(uint64_t records, const std::filesystem::path& file)
      : spec_(PixelSpec(kChannels)),
        ring_(spec_, {.file = file, .capacity = records, .run = "bench"}),
        index_(ring_, {}),
        selector_(ring_, index_),
        gather_(ring_, index_, spec_),
        batch_(BatchOf(), spec_) {
    index_.SetSelector(&selector_);
    const RecordLayout layout(spec_);
    for (uint32_t i = 0; i < kDifferent; ++i) {
      // Words, because records are aligned to 8.
      std::vector<uint64_t>& record =
          records_.emplace_back(static_cast<size_t>(layout.record_bytes()) / 8);
      auto* bytes = reinterpret_cast<uint8_t*>(record.data());
      for (uint8_t& pixel : layout.Frame(bytes)) pixel = static_cast<uint8_t>(random_.Next());
      RecordLayout::Header(bytes).version = kRecordVersion;
    }
    for (uint64_t i = 0; i < records; ++i) Insert();
  }
  // The parts refer to each other.
  FullReplay(const FullReplay&) = delete;
  FullReplay& operator=(const FullReplay&) = delete;

  void Insert() {
    auto* bytes = reinterpret_cast<uint8_t*>(records_[sequence_ % kDifferent].data());
    RecordHeader& header = RecordLayout::Header(bytes);
    header.sequence = ++sequence_;
    header.index = static_cast<uint32_t>((sequence_ - 1) % (kEpisodeSteps + 1));
    header.episode = static_cast<uint32_t>((sequence_ - 1) / (kEpisodeSteps + 1));
    header.kind = header.index == 0 ? RecordKind::kReset : RecordKind::kStep;
    header.flags = header.index == kEpisodeSteps ? kTruncated : 0;
    const auto previous = index_.Predecessor(/*actor=*/0, /*session=*/1, header);
    CHECK(previous) << "record " << sequence_;
    index_.Added(ring_.Append(0, 1, *previous, bytes));
  }

  // Draws a batch and gathers it, shifted.
  void Draw(replay::GatherThreads* threads = nullptr) {
    const auto plan =
        DrawPlan({.batch = kBatch, .copies = 1, .shift_pad = kPad}, &selector_, nullptr, &random_);
    CHECK(plan.has_value());
    if (threads == nullptr) return gather_.Gather(*plan, batch_.batch);
    const replay::FrameCopies copies = gather_.GatherAllButFrames(*plan, batch_.batch);
    threads->Finish(threads->Start(copies.parts(), [&](int part) { copies.MakePart(part); }));
  }

  // Copies as many frames as a batch holds from anywhere in the ring to where the batch goes.
  void Copy() {
    const auto frame_bytes = static_cast<size_t>(ring_.layout().frame_bytes());
    for (const auto& frames : {batch_.batch.obs_frames, batch_.batch.next_obs_frames}) {
      for (int b = 0; b < kBatch; ++b) {
        const uint64_t id =
            ring_.oldest_id() + random_.Below(ring_.last_id() - ring_.oldest_id() + 1);
        std::memcpy(frames.data() + static_cast<size_t>(b) * frame_bytes,
                    ring_.layout().Frame(ring_.Record(id)).data(), frame_bytes);
      }
    }
  }

  void InsertAndDraw() {
    for (int i = 0; i < kInserts; ++i) Insert();
    Draw();
  }

 private:
  static Config BatchOf() {
    Config config;
    config.learner.batch = kBatch;
    return config;
  }

  const ObservationSpec spec_;
  replay::Ring ring_;
  replay::EpisodeIndex index_;
  replay::UniformSelector selector_;
  replay::BatchGather gather_;
  NoiseBatch batch_;
  Random random_{1};
  std::vector<std::vector<uint64_t>> records_;
  uint64_t sequence_ = 0;
};

// Filled when a row first asks for them; gone with the last row that does.
class Replays {
 public:
  FullReplay& Few() { return Get(&few_, kFew, {}); }
  FullReplay& Many() { return Get(&many_, kMany, {}); }
  // In the working folder, which is on a disk where the system's folder for temporary files is not.
  FullReplay& InFile() {
    if (!folder_) folder_.emplace(std::filesystem::current_path());
    return Get(&in_file_, kFew, folder_->path() / "replay.ring");
  }

 private:
  static FullReplay& Get(std::unique_ptr<FullReplay>* replay, uint64_t records,
                         const std::filesystem::path& file) {
    if (!*replay) *replay = std::make_unique<FullReplay>(records, file);
    return **replay;
  }

  std::optional<launch::ScratchFolder> folder_;
  std::unique_ptr<FullReplay> few_, many_, in_file_;
};

// The same batches drawn by several threads, compared with one thread.
std::vector<Pairing> ThreadPairings(const std::shared_ptr<Replays>& replays,
                                    const std::string& drawn) {
  std::vector<Pairing> pairings;
  for (const int threads : {2, 4}) {
    const auto gatherers = std::make_shared<replay::GatherThreads>(threads);
    pairings.push_back(
        {.stage = fmt::format("{}, of {} records, by {} threads", drawn, kFew, threads),
         .unit = "batches/s",
         .against = "one thread",
         .ours = [replays, gatherers] { replays->Few().Draw(gatherers.get()); },
         .other = [replays] { replays->Few().Draw(); }});
    if (threads == 2) pairings.back().target = kTwoThreadsTarget;
    if (threads > UsableCores()) pairings.back().skipped = "too few cores";
  }
  return pairings;
}

}  // namespace

std::vector<Pairing> GatherPairings() {
  const auto replays = std::make_shared<Replays>();
  const std::string drawn =
      fmt::format("{} samples of ({}, 84, 84), drawn and shifted", kBatch, kChannels);
  std::vector<Pairing> pairings{
      {.stage = fmt::format("{}, of {} records", drawn, kFew),
       .unit = "batches/s",
       .against = "memcpy of as many random frames",
       .target = kCopyTarget,
       .ours = [replays] { replays->Few().Draw(); },
       .other = [replays] { replays->Few().Copy(); }},
      {.stage = fmt::format("{}, of {} records", drawn, kMany),
       .unit = "batches/s",
       .against = "memcpy of as many random frames",
       .target = kCopyTarget,
       .ours = [replays] { replays->Many().Draw(); },
       .other = [replays] { replays->Many().Copy(); }},
      {.stage = fmt::format("{}, of {} records", drawn, kMany),
       .unit = "batches/s",
       .against = fmt::format("of {} records", kFew),
       .target = kManyTarget,
       .ours = [replays] { replays->Many().Draw(); },
       .other = [replays] { replays->Few().Draw(); }},
      {.stage = fmt::format("{} records in, {}, ring in a file", kInserts, drawn),
       .unit = "batches/s",
       .against = "ring in memory",
       .target = kFileTarget,
       .ours = [replays] { replays->InFile().InsertAndDraw(); },
       .other = [replays] { replays->Few().InsertAndDraw(); }}};
  std::ranges::move(ThreadPairings(replays, drawn), std::back_inserter(pairings));
  return pairings;
}

}  // namespace shoal::bench
