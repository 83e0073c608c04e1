// A program's line to a running run: hears the views that its coordinator shows, sends it commands.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/dds/bus.h"
#include "common/dds/subscriber.h"
#include "launch/run_target.h"

namespace shoal::launch {

// One thread.
class RunClient {
 public:
  // Joins the run's network. Throws Error.
  explicit RunClient(const RunTarget& target);

  // The next view not returned before, waiting until `deadline` or a stop signal.
  std::optional<RunViewMessage> WaitForView(SteadyTime deadline);
  // The first view. Throws Error naming the run when the coordinator does not answer in time.
  RunViewMessage FirstView();

  static constexpr std::chrono::seconds kAnswer{5};

 private:
  const RunTarget target_;
  Mutex mutex_;
  ConditionVariable arrived_;
  std::optional<RunViewMessage> view_ SHOAL_GUARDED_BY(mutex_);
  dds::Bus bus_;
  dds::Subscriber<RunViewMessage> views_;  // last: its callback uses the rest
};

}  // namespace shoal::launch
