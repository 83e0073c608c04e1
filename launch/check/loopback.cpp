// SPDX-License-Identifier: Apache-2.0
#include "launch/check/loopback.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/mutex.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "launch/processes/child_process.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr size_t kChunkBytes = 1'000'000;
constexpr uint64_t kWindow = 4;  // chunks
constexpr seconds kMeetingDeadline{15}, kAcknowledgementDeadline{5};
constexpr milliseconds kPoll{20}, kGreeting{100};
constexpr seconds kPeerLife{60};  // unless it is stopped earlier

// The highest number received, passed from a receive thread to a waiting thread.
class HighestHeard {
 public:
  void Hear(uint64_t number) {
    {
      const MutexLock lock(mutex_);
      if (heard_ && number <= *heard_) return;
      heard_ = number;
    }
    changed_.NotifyAll();
  }
  // Returns the number reported last, at the deadline or once it is at least `wanted`; empty if
  // nothing was received.
  std::optional<uint64_t> WaitFor(uint64_t wanted, SteadyTime deadline) {
    const MutexLock lock(mutex_);
    while (!(heard_ && *heard_ >= wanted)) {
      if (!changed_.WaitUntil(mutex_, deadline)) break;
    }
    return heard_;
  }

 private:
  Mutex mutex_;
  ConditionVariable changed_;
  std::optional<uint64_t> heard_ SHOAL_GUARDED_BY(mutex_);
};

// Waits until the peer's greeting has arrived and our writer has matched the peer's reader. Chunks
// sent before the match are lost.
void Meet(HighestHeard* acknowledged, const link::Writer<TransitionChunk>& publisher,
          ChildProcess* peer) {
  const SteadyTime deadline = Now() + kMeetingDeadline;
  while (Now() < deadline && !StopRequested()) {
    const bool greeted = acknowledged->WaitFor(UINT64_MAX, Now() + kPoll).has_value();
    if (greeted && publisher.Matched() > 0) return;
    if (const auto ended = peer->Poll()) {
      throw RuntimeError("the second process ended with {}", ended->Describe());
    }
  }
  throw RuntimeError("two processes did not find each other within {} s", kMeetingDeadline.count());
}

}  // namespace

LoopbackRate MeasureLoopback(const TransportConfig& transport, milliseconds duration) {
  const ScratchFolder folder;
  ClusterAddress address;
  const auto bus = dds::ClaimDomain(transport, &address);
  WriteClusterAddress(folder.path(), address);
  HighestHeard acknowledged;
  link::Writer<TransitionChunk> publisher(*bus);
  const link::Reader<CreditsMessage> credits(*bus, [&](const CreditsMessage& message) {
    for (const Credit& credit : message.credits) acknowledged.Hear(credit.stored);
  });
  ProcessSpec spec = ProgramSpec("shoal", {"check", "--loopback-peer", folder.path().string()}, 1);
  spec.role = "loopback";
  spec.output = folder.path() / "peer.log";
  ChildProcess peer(spec);
  Meet(&acknowledged, publisher, &peer);

  const std::vector<uint8_t> payload(kChunkBytes, 0x5a);
  TransitionChunk chunk;
  chunk.count = 1;
  chunk.session = 1;
  chunk.payload = payload;
  uint64_t sent = 0, arrived = 0;
  const SteadyTime start = Now();
  const auto wait_for = [&](uint64_t number) {
    arrived = acknowledged.WaitFor(number, Now() + kAcknowledgementDeadline).value_or(0);
    if (arrived >= number) return;
    throw RuntimeError("chunk {} of {} was not acknowledged within {} s", arrived + 1, sent,
                       kAcknowledgementDeadline.count());
  };
  while (Now() - start < duration && !StopRequested()) {
    chunk.first_sequence = sent + 1;
    if (!publisher.Write(chunk)) continue;  // not sent in time: try again
    ++sent;
    if (sent > kWindow) wait_for(sent - kWindow);
  }
  wait_for(sent);
  return {.chunks = arrived, .bytes = arrived * kChunkBytes, .seconds = SecondsSince(start)};
}

int RunLoopbackPeer(const std::filesystem::path& folder, const TransportConfig& transport) {
  dds::Bus bus(ReadClusterAddress(folder), transport, dds::Role::kReplay);
  HighestHeard stored;
  stored.Hear(0);
  link::Writer<CreditsMessage> publisher(bus);
  uint64_t next = 1;  // used by the receive thread only
  const link::Reader<TransitionChunk> chunks(bus, [&](const TransitionChunk& chunk) {
    if (chunk.first_sequence != next || chunk.payload.size() != kChunkBytes) return;
    stored.Hear(next++);
  });
  Credit credit;
  credit.replay_session = credit.session = 1;
  const SteadyTime end = Now() + kPeerLife;
  while (!StopRequested() && Now() < end) {
    publisher.Write({{credit}});
    credit.stored = stored.WaitFor(credit.stored + 1, Now() + kGreeting).value_or(0);
  }
  return 0;
}

CheckLine JudgeLoopback(const LoopbackRate& rate, double needed) {
  CheckLine line{"dds loopback", Verdict::kOk,
                 fmt::format("{:.0f} MB/s in chunks of 1 MB between two processes; the default "
                             "preset's records at 30 updates/s are {:.0f} MB/s",
                             rate.MegabytesPerSecond(), needed),
                 ""};
  if (rate.chunks == 0) {
    line.verdict = Verdict::kFail;
    line.finding = "nothing arrived";
    line.advice = "see that the firewall lets UDP through on the loopback interface";
  } else if (rate.MegabytesPerSecond() < needed) {
    line.verdict = Verdict::kWarn;
    line.advice =
        "actors will wait for the replay: free a core, or raise net.core.rmem_max to "
        "16 MB (sysctl -w net.core.rmem_max=16777216)";
  }
  return line;
}

}  // namespace shoal::launch
