// SPDX-License-Identifier: Apache-2.0
// A link to a replay server that the test simulates, and the clock of sender and link. Time passes
// only while the sender waits for a credit.
#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "actor/sending/chunk_link.h"

namespace shoal::actor {

struct FakeClock {
  SteadyTime now{std::chrono::hours(1)};
  std::function<SteadyTime()> Reader() {
    return [this] { return now; };
  }
};

class FakeLink final : public ChunkLink {
 public:
  struct SentChunk {
    uint64_t first = 0, last = 0;  // sequences of the first and last record
    SteadyTime time;
    std::vector<uint8_t> bytes;
  };

  explicit FakeLink(FakeClock& clock) : clock_(clock) {}

  std::optional<Credit> TakeCredit(SteadyTime deadline) override {
    if (answer) answer();
    if (credits.empty()) {
      if (deadline > clock_.now) clock_.now = deadline;
      return std::nullopt;
    }
    const Credit credit = credits.front();
    credits.pop_front();
    return credit;
  }
  bool Connected() override { return connected; }
  bool Send(const TransitionChunk& chunk) override {
    if (!taking) return false;
    if (chunk.count == 0) {
      positions.push_back(chunk.first_sequence);
      return true;
    }
    sent.push_back({chunk.first_sequence,
                    chunk.first_sequence + chunk.count - 1,
                    clock_.now,
                    {chunk.payload.begin(), chunk.payload.end()}});
    return true;
  }

  std::function<void()> answer;  // called at each poll for a credit
  std::deque<Credit> credits;
  std::vector<SentChunk> sent;
  std::vector<uint64_t> positions;  // first retained sequence, from each chunk without records
  bool connected = true, taking = true;

 private:
  FakeClock& clock_;
};

}  // namespace shoal::actor
