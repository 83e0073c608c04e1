// SPDX-License-Identifier: Apache-2.0
// Source of a training actor's weights. One process of each host receives the weights and writes
// them to a board in shared memory (weights_board.h); the other processes of the host read the
// board. A version is therefore sent and unpacked once per host, not once per actor.
//
// The process that holds the lock RUN/made/weights-HOST.lock is the receiver. The receiver writes
// the address of its board to RUN/made/weights-HOST.json. The kernel frees the lock when its holder
// ends. The other processes try to take the lock once a second; the process that takes the lock
// becomes the receiver. If a process cannot read the board for kPatience (another PID namespace,
// another user, a stopped holder), the process receives weights for itself alone until it ends.
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

// One thread. Only the inbox is also used by the receive thread.
class HostWeights final : public WeightsSource {
 public:
  // Subscribes the inbox to weights. Destroying the returned object ends the subscription.
  using Subscribe = std::function<std::shared_ptr<void>(WeightsInbox&)>;

  // `host` names this host in file names. The first TryTake() takes the lock or opens the board.
  HostWeights(const std::filesystem::path& run, const std::string& host, uint64_t spec_hash,
              Subscribe subscribe);

  std::optional<ReceivedWeights> TryTake() override;

  // True if this process receives weights, for its neighbours or for itself alone.
  bool receives() const { return subscription_ != nullptr; }
  uint64_t refused() const { return inbox_.refused(); }

  static constexpr std::chrono::seconds kLook{1}, kPatience{3};

 private:
  void Look(SteadyTime now);
  bool TryReceiveForHost();
  // Opens the board of the lock's holder. Returns the reason if the board cannot be used; empty =
  // the board can be used.
  std::string OpenBoard();
  void ReceiveAlone(const std::string& reason);
  void Post(const ReceivedWeights& weights);

  const std::filesystem::path lock_file_, address_file_;
  const uint64_t spec_hash_;
  const Subscribe subscribe_;
  WeightsVersion taken_;

  SteadyTime next_look_{};
  std::optional<SteadyTime> useless_since_;  // time at which reading the board first failed
  std::unique_ptr<WeightsBoardReader> reader_;

  std::optional<FileLock> lock_;
  std::unique_ptr<WeightsBoard> board_;  // used by the receive thread during the subscription
  WeightsInbox inbox_;
  std::shared_ptr<void> subscription_;
};

}  // namespace shoal::actor
