// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/drawn_batches.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "common/base/clock.h"
#include "common/base/random.h"
#include "common/dds/bus.h"
#include "common/link/writer.h"
#include "common/run_folder/run_file_names.h"
#include "learner/batch_feed.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/session_table.h"
#include "replay_server/service/replay_service.h"
#include "tests/benchmark/forked_processes.h"
#include "tests/support/processes.h"

namespace shoal::bench {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr uint64_t kDrawnFor = 1, kActorSession = 1;
constexpr uint32_t kEpisodeSteps = 50, kDifferent = 64;
constexpr seconds kFirstBatch{60};
constexpr double kSettling = 2;  // seconds; the replay chooses the number of its threads

RunConfig DrawnRun(const DrawnOptions& options) {
  RunConfig run = TwoCameraRun("drawn");
  run.config.actors = 1;
  run.config.learner.batch = options.batch;
  run.config.learner.request_credits = options.credits;
  run.config.replay.capacity = options.records;
  run.config.replay.min_size = 1;
  run.config.replay.samples_per_insert = Schedule::Constant(0);
  run.config.replay.storage = "file";
  run.config.replay.threads = options.threads;
  return run;
}

// Stores episodes of one actor, as an earlier server of the run would have.
void FillRing(const RunConfig& run, const std::filesystem::path& folder) {
  replay::Ring ring(run.spec, {.file = folder / kRingFile,
                               .capacity = static_cast<uint64_t>(run.config.replay.capacity),
                               .run = "drawn"});
  replay::SessionTable(ring.sessions()).Add(/*actor=*/0, kActorSession);
  const RecordLayout layout(run.spec);
  Random random(1);
  std::vector<std::vector<uint64_t>> records;  // words, because records are aligned to 8
  for (uint32_t i = 0; i < kDifferent; ++i) {
    auto& record = records.emplace_back(static_cast<size_t>(layout.record_bytes()) / 8);
    for (uint64_t& word : record) word = random.Next();
  }
  uint64_t previous = 0;
  for (uint64_t sequence = 1; sequence <= ring.capacity(); ++sequence) {
    auto* bytes = reinterpret_cast<uint8_t*>(records[sequence % kDifferent].data());
    RecordHeader header{};
    header.version = kRecordVersion;
    header.sequence = sequence;
    header.index = static_cast<uint32_t>((sequence - 1) % (kEpisodeSteps + 1));
    header.episode = static_cast<uint32_t>((sequence - 1) / (kEpisodeSteps + 1));
    header.kind = header.index == 0 ? RecordKind::kReset : RecordKind::kStep;
    header.flags = header.index == kEpisodeSteps ? kTruncated : 0;
    RecordLayout::Header(bytes) = header;
    previous = ring.Append(0, kActorSession, header.index == 0 ? 0 : previous, bytes);
  }
}

void ServeDrawn(const RunConfig& run, const DrawnOptions& options, const Pipe<Meeting>& meeting) {
  FillRing(run, options.folder);
  const Meeting where = FreeMeeting(run.config.transport);
  const ClusterAddress address = AddressOf(where);
  WriteRunConfig(options.folder, run);
  WriteClusterAddress(options.folder, address);
  dds::Bus bus(address, run.config.transport, dds::Role::kReplay);
  replay::ReplayService service(options.folder, {"replay"}, bus);
  meeting.Write(where);
  service.Run();
}

// The learner's figures at the begin of the measurement, and at its end.
struct Mark {
  double batches = 0, wall = 0, cpu = 0;
};

// Requests batches until the process is killed, and is the coordinator for the replay.
void Request(const RunConfig& run, const DrawnOptions& options, const ClusterAddress& address,
             const Pipe<Mark>& marks) {
  dds::Bus bus(address, run.config.transport, dds::Role::kLearner);
  link::Writer<ControlMessage> control(bus);
  ControlMessage order{.epoch = 1};
  const auto feed = learner::MakeFeed("", run, kDrawnFor, 0, bus, {});
  const SteadyTime start = Now();
  SteadyTime last_beat{};
  double batches = 0, due = kSettling;
  while (true) {
    if (Now() - last_beat > milliseconds(300)) {
      last_beat = Now();
      order.time = WallTimeSeconds();
      control.Write(order);
    }
    if (!feed->stream().Next(Now() + milliseconds(300))) {
      if (SecondsSince(start) > kFirstBatch.count()) throw RuntimeError("no batch came");
      continue;
    }
    ++batches;
    if (const double wall = SecondsSince(start); wall > due) {
      marks.Write({batches, wall, CpuSeconds()});
      due += options.seconds;
    }
  }
}

}  // namespace

DrawnFigures MeasureDrawn(const DrawnOptions& options) {
  const RunConfig run = DrawnRun(options);
  Pipe<Meeting> meeting;
  Pipe<Mark> marks;
  const pid_t replay = Fork("replay", [&] { ServeDrawn(run, options, meeting); });
  const pid_t learner =
      Fork("learner", [&] { Request(run, options, AddressOf(meeting.Read()), marks); });
  marks.CloseWriter();
  const Mark begin = marks.Read();
  const double replay_then = ProcessorSeconds(replay);
  const Mark end = marks.Read();
  const double replay_cpu = ProcessorSeconds(replay) - replay_then;
  for (const pid_t child : {learner, replay}) kill(child, SIGKILL);
  for (const pid_t child : {learner, replay}) waitpid(child, nullptr, 0);
  const double batches = end.batches - begin.batches;
  return {.batches_per_second = batches / (end.wall - begin.wall),
          .replay_seconds = replay_cpu / batches,
          .learner_seconds = (end.cpu - begin.cpu) / batches};
}

}  // namespace shoal::bench
