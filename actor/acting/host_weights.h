// SPDX-License-Identifier: Apache-2.0
// Source of a training actor's weights: one process of a host receives them and posts them on a
// board (weights_board.h), the others read them there. So a version crosses the network, and is
// unpacked, once per host and not once per actor.
//
// The process that holds the lock RUN/made/weights-HOST.lock receives, and writes the address of
// its board beside it, into RUN/made/weights-HOST.json. The lock is free as soon as its holder
// ends, for whatever reason. The neighbours try to take it once a second; the one that succeeds
// receives from then on. A process that cannot read the board for kPatience (another namespace of
// processes, another user, a holder that is stopped) receives for itself, until it ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "actor/acting/weights_board.h"
#include "actor/acting/weights_inbox.h"
#include "common/base/clock.h"
#include "common/base/file_lock.h"

namespace shoal::actor {

// One thread, but for what the inbox takes from the receive thread.
class HostWeights final : public WeightsSource {
 public:
  // Lets parts come into the inbox until what it returns is destroyed.
  using Subscribe = std::function<std::shared_ptr<void>(WeightsInbox&)>;

  // `host` names this host in file names. Nothing happens before the first TryTake().
  HostWeights(const std::filesystem::path& run, const std::string& host, uint64_t spec_hash,
              Subscribe subscribe);

  std::optional<ReceivedWeights> TryTake() override;

  // Whether this process receives, for its neighbours or for itself alone.
  bool receives() const { return subscription_ != nullptr; }
  uint64_t refused() const { return inbox_.refused(); }

  static constexpr std::chrono::seconds kLook{1}, kPatience{3};

 private:
  void Look(SteadyTime now);
  bool TryReceiveForHost();
  // Why the holder's board is of no use now; empty while it is.
  std::string OpenBoard();
  void ReceiveAlone(const std::string& reason);
  void Post(const ReceivedWeights& weights);

  const std::filesystem::path lock_file_, address_file_;
  const uint64_t spec_hash_;
  const Subscribe subscribe_;
  WeightsVersion taken_;

  SteadyTime next_look_{};
  std::optional<SteadyTime> useless_since_;  // the board
  std::unique_ptr<WeightsBoardReader> reader_;

  std::optional<FileLock> lock_;
  std::unique_ptr<WeightsBoard> board_;  // the receive thread's once there is a subscription
  WeightsInbox inbox_;
  std::shared_ptr<void> subscription_;
};

}  // namespace shoal::actor
