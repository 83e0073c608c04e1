// SPDX-License-Identifier: Apache-2.0
// The run's server for watching and control (docs/monitoring.md): publishes a view of the whole run
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

// Exists from the run's start until after the run's last evaluation. One thread.
class RunServer {
 public:
  // Borrows the coordinator's hub. `on_view` gets every published view; may be null.
  RunServer(link::Hub& hub, const std::string& run,
            std::function<void(const RunViewMessage&)> on_view = nullptr);
  // Waits a moment so that watchers receive the last view.
  ~RunServer();
  RunServer(const RunServer&) = delete;
  RunServer& operator=(const RunServer&) = delete;

  // Adds a line for people; watchers receive the last kEvents lines.
  void AddEvent(const std::string& text);

  // Whether the next view is due.
  bool Due(SteadyTime now) const { return !shown_ || now - *shown_ >= kPeriod; }
  // Publishes `view`, with name, time and events filled in.
  void Show(RunViewMessage view, SteadyTime now);
  // Publishes the coordinator's metrics of the last view again, with another state, if a view is
  // due. Call after all other processes have exited.
  void ShowAgain(const std::string& state, SteadyTime now);
  // Publishes the last view: state "ended", with the coordinator's metric `exit_code`.
  void ShowEnd(int exit_code);

  // Returns the received commands, each once. A repeated command gets the earlier reply again.
  std::vector<CommandMessage> TakeCommands();
  void Answer(const ReplyMessage& reply);

  static constexpr std::chrono::seconds kPeriod{1};
  static constexpr size_t kEvents = 50;
  static constexpr size_t kClients = 64;  // clients whose last reply is stored
  static constexpr size_t kCommands = 100;

 private:
  // Removes the reports of all other processes, which have exited.
  void OnlyCoordinator(const std::string& state);
  void Publish(SteadyTime now);

  const std::function<void(const RunViewMessage&)> on_view_;
  link::Writer<RunViewMessage> publisher_;
  link::Writer<ReplyMessage> replies_;
  std::deque<RunEvent> events_;
  uint64_t last_event_ = 0;
  RunViewMessage view_;
  std::optional<SteadyTime> shown_;
  std::deque<ReplyMessage> answered_;  // last reply to each client, the newest at the end
  MessageInbox<CommandMessage> inbox_{kCommands};
  link::Reader<CommandMessage> commands_;  // the last member, because its callback uses the inbox
};

}  // namespace shoal::launch
