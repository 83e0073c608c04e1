// SPDX-License-Identifier: Apache-2.0
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
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "launch/watch/run_target.h"

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

  // Sends a command and returns what the coordinator did. Throws Error: refused, with its reason,
  // or no answer in time.
  ReplyMessage Order(const std::string& verb, const std::vector<std::string>& arguments);

  static constexpr std::chrono::seconds kAnswer{5};

 private:
  // The reply to the command; empty when there is none within kAnswer.
  std::optional<ReplyMessage> Ask(const CommandMessage& command);

  const RunTarget target_;
  const uint64_t client_;  // names this client among all
  uint64_t requests_ = 0;
  Mutex mutex_;
  ConditionVariable arrived_;
  std::optional<RunViewMessage> view_ SHOAL_GUARDED_BY(mutex_);
  std::optional<ReplyMessage> reply_ SHOAL_GUARDED_BY(mutex_);
  dds::Bus bus_;
  link::Writer<CommandMessage> commands_;
  link::Reader<ReplyMessage> replies_;
  link::Reader<RunViewMessage> views_;  // last: its callback uses the rest
};

// The exit code of a run that has ended, from its last view.
int ExitCodeOf(const RunViewMessage& view);

}  // namespace shoal::launch
