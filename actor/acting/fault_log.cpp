// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/fault_log.h"

#include <algorithm>
#include <numeric>

#include "common/base/error.h"
#include "common/base/log.h"

namespace shoal::actor {

uint64_t FaultLog::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), uint64_t{0});
}

void FaultLog::Add(bool faulty) {
  recent_[next_] = faulty;
  next_ = (next_ + 1) % kWindow;
  episodes_ = std::min(episodes_ + 1, kWindow);
}

void FaultLog::Count(const worlds::EpisodeFault& fault) {
  ++counts_[static_cast<size_t>(fault.cause())];
  Add(true);
  if (max_share_ <= 0) throw NonFiniteError("{}", fault.what());
  if (static_cast<double>(recent_.count()) > max_share_ * double{kWindow}) {
    throw NonFiniteError("{}; {} of the last {} episodes ended so (max_faulty_share = {})",
                         fault.what(), recent_.count(), episodes_, max_share_);
  }
  Log(fault);
}

void FaultLog::Log(const worlds::EpisodeFault& fault) {
  ++unsaid_;
  const SteadyTime now = now_();
  if (logged_ && now - *logged_ < kLogPeriod) return;
  logged_ = now;
  const std::string others =
      unsaid_ > 1 ? fmt::format("{} since the last such line, ", unsaid_) : "";
  unsaid_ = 0;
  log::Warning("{}: the episode ends there, truncated ({}{} faulty episodes so far)", fault.what(),
               others, total());
}

}  // namespace shoal::actor
