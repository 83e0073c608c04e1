// SPDX-License-Identifier: Apache-2.0
#include "launch/client/run_client.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/interrupted.h"
#include "common/base/saturating_cast.h"
#include "common/base/stop.h"
#include "common/link/role.h"
#include "launch/watch/metrics_view.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::milliseconds kPoll{100};  // interval between checks for stop signals
constexpr std::chrono::milliseconds kResend{500};

void ThrowIfInterrupted() {
  if (StopRequested()) throw Interrupted("before the run's coordinator answered");
}

std::optional<double> FigureOfCoordinator(const RunViewMessage& view, std::string_view name) {
  for (const MetricsMessage& process : view.processes) {
    if (process.role == link::RoleName(link::Role::kCoordinator)) return FigureOf(process, name);
  }
  return std::nullopt;
}

}  // namespace

RunClient::RunClient(link::Hub& hub, const RunTarget& target, uint64_t id)
    : target_(target),
      id_(id),
      commands_(hub),
      replies_(hub,
               [this](const ReplyMessage& reply) {
                 if (reply.client != id_) return;
                 const MutexLock lock(mutex_);
                 reply_ = reply;
                 arrived_.NotifyAll();
               }),
      views_(hub, [this](const RunViewMessage& view) {
        const MutexLock lock(mutex_);
        view_ = view;
        arrived_.NotifyAll();
      }) {}

std::optional<RunViewMessage> RunClient::WaitForView(SteadyTime deadline) {
  const MutexLock lock(mutex_);
  while (!view_ && Now() < deadline && !StopRequested()) {
    arrived_.WaitUntil(mutex_, std::min(deadline, Now() + kPoll));
  }
  return std::exchange(view_, std::nullopt);
}

RunViewMessage RunClient::FirstView() {
  if (auto view = WaitForView(Now() + kAnswer)) return *std::move(view);
  ThrowIfInterrupted();
  throw RuntimeError(
      "run '{}': its coordinator at {} did not answer within {} s; it may be paused (Ctrl-Z) "
      "or about to end: see shoal runs",
      target_.name, target_.coordinator, kAnswer.count());
}

std::optional<ReplyMessage> RunClient::Ask(const CommandMessage& command) {
  const SteadyTime deadline = Now() + kAnswer;
  SteadyTime next_send{};
  while (Now() < deadline && !StopRequested()) {
    // Resends are safe: the coordinator executes a request once.
    if (Now() >= next_send && commands_.Matched() > 0 && replies_.Matched() > 0) {
      commands_.Write(command);
      next_send = Now() + kResend;
    }
    const MutexLock lock(mutex_);
    if (reply_ && reply_->request == command.request) return std::exchange(reply_, std::nullopt);
    arrived_.WaitUntil(mutex_, std::min(deadline, Now() + kPoll));
  }
  return std::nullopt;
}

ReplyMessage RunClient::Order(const std::string& verb, const std::vector<std::string>& arguments) {
  const auto reply =
      Ask({.client = id_, .request = ++requests_, .verb = verb, .arguments = arguments});
  if (!reply) {
    ThrowIfInterrupted();
    throw RuntimeError(
        "run '{}': its coordinator at {} did not answer the command within {} s; it may be "
        "paused (Ctrl-Z) or about to end: see shoal runs",
        target_.name, target_.coordinator, kAnswer.count());
  }
  if (!reply->accepted) throw RuntimeError("refused: {}", reply->text);
  return *reply;
}

int ExitCodeOf(const RunViewMessage& view) {
  return SaturatingCast<int>(FigureOfCoordinator(view, "exit_code").value_or(1));
}

bool SameCoordinator::Take(const RunViewMessage& view) {
  const double before = uptime_;
  uptime_ = FigureOfCoordinator(view, "uptime_seconds").value_or(before);
  return uptime_ >= before;
}

}  // namespace shoal::launch
