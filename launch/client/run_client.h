// SPDX-License-Identifier: Apache-2.0
// A program's connection to a running run: receives the coordinator's views and sends commands to
// the coordinator, over any link.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/link/hub.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "launch/watch/run_target.h"

namespace shoal::launch {

// One thread.
class RunClient {
 public:
  // `hub` has the role of a client of the run. `id` identifies this client among all clients of the
  // run, past and future; not 0. Borrows the hub. Throws Error.
  RunClient(link::Hub& hub, const RunTarget& target, uint64_t id);

  // Returns the next new view. Waits for a view until `deadline` or a stop signal; empty if no view
  // arrived.
  std::optional<RunViewMessage> WaitForView(SteadyTime deadline);
  // The first view. If the coordinator does not answer in time, throws Error naming the run.
  RunViewMessage FirstView();

  // Sends a command and returns the coordinator's reply. Throws Error if the coordinator refuses
  // the command (with the reason) or does not answer in time.
  ReplyMessage Order(const std::string& verb, const std::vector<std::string>& arguments);

  static constexpr std::chrono::seconds kAnswer{5};

 private:
  // The reply to the command; empty if no reply arrives within kAnswer.
  std::optional<ReplyMessage> Ask(const CommandMessage& command);

  const RunTarget target_;
  const uint64_t id_;
  uint64_t requests_ = 0;
  Mutex mutex_;
  ConditionVariable arrived_;
  std::optional<RunViewMessage> view_ SHOAL_GUARDED_BY(mutex_);
  std::optional<ReplyMessage> reply_ SHOAL_GUARDED_BY(mutex_);
  link::Writer<CommandMessage> commands_;
  link::Reader<ReplyMessage> replies_;
  link::Reader<RunViewMessage> views_;  // last, because its callback uses the other members
};

// The exit code of a run that has ended, from its last view.
int ExitCodeOf(const RunViewMessage& view);

// Detects views of a new coordinator, which show that the run was resumed.
class SameCoordinator {
 public:
  // Returns false if `view` is the first view of a new coordinator.
  bool Take(const RunViewMessage& view);

 private:
  double uptime_ = 0;  // s
};

}  // namespace shoal::launch
