// SPDX-License-Identifier: Apache-2.0
// Transport: chunks of records from an actor to a replay in another process, secured and plain.
#include <fmt/core.h>

#include <memory>
#include <vector>

#include "common/base/check.h"
#include "common/credentials/credentials.h"
#include "common/dds/role_rights.h"
#include "launch/processes/scratch_folder.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/common/dds/peer_process.h"

namespace shoal::bench {
namespace {

constexpr int kChunksPerCall = 64;

// A coordinator, a replay and an actor on a domain of their own.
class Transport {
 public:
  // `secure`: folder of credentials; empty = none.
  Transport(const std::string& secure, size_t chunk_bytes)
      : chunk_bytes_(chunk_bytes),
        coordinator_(secure),
        replay_("replay", coordinator_.address()),
        actor_("actor", coordinator_.address()) {
    replay_.Ask("subscribe TransitionChunk");
    actor_.Ask("publish TransitionChunk");
    CHECK(actor_.Ask("match TransitionChunk 1 10000") == "matched 1");
  }

  // Sends chunks and waits until all have come.
  void Send() {
    actor_.Ask(
        fmt::format("write TransitionChunk {} {} {}", sent_ + 1, kChunksPerCall, chunk_bytes_));
    sent_ += kChunksPerCall;
    const std::string answer = replay_.Ask(fmt::format("received TransitionChunk {} 30000", sent_));
    CHECK(answer.starts_with(fmt::format("received {} gaps 0 ", sent_))) << answer;
  }

 private:
  const size_t chunk_bytes_;
  dds::PeerProcess coordinator_, replay_, actor_;
  uint64_t sent_ = 0;
};

// Credentials of their own, made when first asked for.
const std::string& Credentials() {
  static const launch::ScratchFolder scratch;
  static const std::string folder = [] {
    std::string made = scratch.path() / "secure";
    CreateCredentials(made, dds::AllRoleRights(), ValidForDays(1));
    return made;
  }();
  return folder;
}

// Starts the processes at its first call, which is not timed.
std::function<void()> Sender(size_t chunk_bytes, bool secured) {
  const auto transport = std::make_shared<std::unique_ptr<Transport>>();
  return [=] {
    if (!*transport) {
      *transport = std::make_unique<Transport>(secured ? Credentials() : "", chunk_bytes);
    }
    (*transport)->Send();
  };
}

Pairing SecuredAgainstPlain(size_t chunk_bytes) {
  return {.stage = fmt::format("chunks of {} kB to the replay, secured", chunk_bytes / 1000),
          .unit = "chunks/s",
          .against = "plain",
          .units_per_call = kChunksPerCall,
          .ours = Sender(chunk_bytes, true),
          .other = Sender(chunk_bytes, false)};
}

}  // namespace

std::vector<Pairing> TransportPairings() {
  return {SecuredAgainstPlain(50'000), SecuredAgainstPlain(1'000'000)};
}

}  // namespace shoal::bench
