// SPDX-License-Identifier: Apache-2.0
// Log of faulty episodes, which end because a number of the simulation is not finite. Counts faulty
// episodes by cause, logs at most one line in ten seconds, and ends the run if there are too many.
//
//   too many: more than max_faulty_share * kWindow of the newest kWindow episodes were faulty
//
// During the first kWindow episodes the limit is the same number of faulty episodes. If all
// episodes of a task are faulty, the run therefore ends early.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "actor/worlds/episode_fault.h"
#include "common/base/clock.h"

namespace shoal::actor {

// One thread.
class FaultLog {
 public:
  static constexpr size_t kWindow = 200;  // episodes
  static constexpr std::chrono::seconds kLogPeriod{10};

  // `max_share`: the key max_faulty_share.
  explicit FaultLog(double max_share, std::function<SteadyTime()> now = Now)
      : max_share_(max_share), now_(std::move(now)) {}

  // Counts an episode that ended without a fault.
  void Ended() { Add(false); }
  // Counts an episode that was faulty or could not begin. If there are too many faulty episodes,
  // throws Error (kNonFinite) with the fault's message.
  void Count(const worlds::EpisodeFault& fault);

  // Faulty episodes of a cause since construction.
  uint64_t count(worlds::FaultCause cause) const { return counts_[static_cast<size_t>(cause)]; }
  uint64_t total() const;

 private:
  void Add(bool faulty);
  void Log(const worlds::EpisodeFault& fault);

  const double max_share_;
  const std::function<SteadyTime()> now_;
  std::bitset<kWindow> recent_;  // the newest episodes; set = faulty
  size_t next_ = 0, episodes_ = 0;
  std::array<uint64_t, worlds::kFaultCauses.size()> counts_{};
  std::optional<SteadyTime> logged_;
  uint64_t unsaid_ = 0;  // faults since the last log line
};

}  // namespace shoal::actor
