// SPDX-License-Identifier: Apache-2.0
// The run's side of watching and steering (docs/monitoring.md): publishes a view of the whole run
// once a second, receives commands and sends the replies.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/wire/messages.h"
#include "launch/watch/message_inbox.h"

namespace shoal::launch {

// Lives from the run's start until after its last evaluation. One thread.
class RunServer {
 public:
  // Borrows the coordinator's hub. `on_view` gets every view that is shown; may be null.
  RunServer(link::Hub& hub, const std::string& run,
            std::function<void(const RunViewMessage&)> on_view = nullptr);
  // Gives watchers a moment to get the last view.
  ~RunServer();
  RunServer(const RunServer&) = delete;
  RunServer& operator=(const RunServer&) = delete;

  // A line for people; watchers get the last kEvents.
  void AddEvent(const std::string& text);

  // Whether the next view is due.
  bool Due(SteadyTime now) const { return !shown_ || now - *shown_ >= kPeriod; }
  // Shows `view`, with name, time and events filled in.
  void Show(RunViewMessage view, SteadyTime now);
  // Shows the figures of the last view again, when due, in another state: no process is left.
  void ShowAgain(const std::string& state, SteadyTime now);
  // The last view: state "ended", with the coordinator's figure `exit_code`.
  void ShowEnd(int exit_code);

  // Commands that came; each one once: one that comes again is answered again as it was.
  std::vector<CommandMessage> TakeCommands();
  void Answer(const ReplyMessage& reply);

  static constexpr std::chrono::seconds kPeriod{1};
  static constexpr size_t kEvents = 50;
  static constexpr size_t kClients = 64;  // whose last reply is remembered
  static constexpr size_t kCommands = 100;

 private:
  // The others have left.
  void OnlyCoordinator(const std::string& state);
  void Publish(SteadyTime now);

  const std::function<void(const RunViewMessage&)> on_view_;
  link::Writer<RunViewMessage> publisher_;
  link::Writer<ReplyMessage> replies_;
  std::deque<RunEvent> events_;
  uint64_t last_event_ = 0;
  RunViewMessage view_;
  std::optional<SteadyTime> shown_;
  std::deque<ReplyMessage> answered_;  // newest last, one per client
  MessageInbox<CommandMessage> inbox_{kCommands};
  link::Reader<CommandMessage> commands_;  // last: its callback uses the inbox
};

}  // namespace shoal::launch
