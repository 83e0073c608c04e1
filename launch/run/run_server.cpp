// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_server.h"

#include <algorithm>
#include <utility>

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kFarewell{1000};

}  // namespace

RunServer::RunServer(link::Hub& hub, const std::string& run,
                     std::function<void(const RunViewMessage&)> on_view)
    : on_view_(std::move(on_view)),
      publisher_(hub),
      replies_(hub),
      commands_(hub, [this](const CommandMessage& command) { inbox_.Put(command); }) {
  view_.run = run;
}

RunServer::~RunServer() {
  if (publisher_.Matched() > 0) publisher_.WaitForAcks(kFarewell);
}

void RunServer::AddEvent(const std::string& text) {
  events_.push_back({.number = ++last_event_, .time = WallTimeSeconds(), .text = text});
  if (events_.size() > kEvents) events_.pop_front();
}

void RunServer::Show(RunViewMessage view, SteadyTime now) {
  view.run = view_.run;
  view_ = std::move(view);
  Publish(now);
}

void RunServer::ShowAgain(const std::string& state, SteadyTime now) {
  if (!Due(now) && view_.state == state) return;
  OnlyCoordinator(state);
  Publish(now);
}

void RunServer::ShowEnd(int exit_code) {
  OnlyCoordinator("ended");
  for (MetricsMessage& process : view_.processes) {
    process.names.push_back("exit_code");
    process.values.push_back(exit_code);
  }
  Publish(Now());
}

void RunServer::OnlyCoordinator(const std::string& state) {
  view_.state = state;
  std::erase_if(view_.processes, [](const auto& process) { return process.role != "coordinator"; });
  for (MetricsMessage& process : view_.processes) process.state = state;
}

void RunServer::Publish(SteadyTime now) {
  view_.time = WallTimeSeconds();
  view_.events = {events_.begin(), events_.end()};
  if (on_view_) on_view_(view_);
  if (publisher_.Write(view_)) shown_ = now;
}

std::vector<CommandMessage> RunServer::TakeCommands() {
  std::vector<CommandMessage> fresh;
  for (const CommandMessage& command : inbox_.TakeAll()) {
    const auto same_client = [&](const auto& other) { return other.client == command.client; };
    const auto before = std::ranges::find_if(answered_, same_client);
    if (before != answered_.end() && before->request == command.request) {
      replies_.Write(*before);
    } else if (std::ranges::none_of(fresh, same_client)) {  // one open command per client
      fresh.push_back(command);
    }
  }
  return fresh;
}

void RunServer::Answer(const ReplyMessage& reply) {
  std::erase_if(answered_, [&](const auto& other) { return other.client == reply.client; });
  answered_.push_back(reply);
  if (answered_.size() > kClients) answered_.pop_front();
  replies_.Write(reply);
}

}  // namespace shoal::launch
