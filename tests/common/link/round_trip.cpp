// SPDX-License-Identifier: Apache-2.0
#include "tests/common/link/round_trip.h"

#include <algorithm>
#include <vector>

#include "common/base/clock.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/peer_endpoint.h"

namespace shoal::link {

PeerCommands::Answerer::Answerer(Hub& hub)
    : writer_(hub),
      thread_([this](const std::stop_token& stop) { Run(stop); }),
      reader_(hub, [this](const TransitionChunk& chunk) {
        const std::lock_guard lock(mutex_);
        newest_ = chunk.first_sequence;
        arrived_.notify_all();
      }) {}

void PeerCommands::Answerer::Run(const std::stop_token& stop) {
  uint64_t answered = 0;
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      arrived_.wait(lock, stop, [&] { return newest_ != answered; });
      answered = newest_;
    }
    WithExample<CreditsMessage>(answered, {},
                                [&](const CreditsMessage& credits) { writer_.Write(credits); });
  }
}

std::string RoundTrip(Hub& hub, uint64_t count, size_t payload_bytes) {
  std::mutex mutex;
  std::condition_variable arrived;
  uint64_t stored = 0;
  Writer<TransitionChunk> writer(hub);
  const Reader<CreditsMessage> reader(hub, [&](const CreditsMessage& credits) {
    const std::lock_guard lock(mutex);
    stored = credits.credits.front().stored;
    arrived.notify_all();
  });
  const SteadyTime start = Now();
  while ((writer.Matched() < 1 || reader.Matched() < 1) && Now() - start < kPeerWriteDeadline) {
    std::this_thread::sleep_for(kPeerPollInterval);
  }
  const std::vector<uint8_t> payload = ExamplePayload(1, payload_bytes);
  std::vector<double> microseconds;
  for (uint64_t n = 1; n <= count; ++n) {
    const SteadyTime sent = Now();
    WithExample<TransitionChunk>(n, payload, [&](const auto& m) { writer.Write(m); });
    std::unique_lock lock(mutex);
    if (!arrived.wait_for(lock, kPeerWriteDeadline, [&] { return stored == n; })) return "lost";
    microseconds.push_back(SecondsSince(sent) * 1e6);
  }
  const double first = microseconds.front();
  microseconds.erase(microseconds.begin());
  std::ranges::sort(microseconds);
  return fmt::format("microseconds {:.0f} {:.0f}, first {:.0f}",
                     microseconds[microseconds.size() / 2], microseconds.back(), first);
}

}  // namespace shoal::link
