// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/python/call_watch.h"

#include <fmt/core.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "common/base/clock.h"
#include "common/base/held_signals.h"
#include "common/base/sleep.h"

namespace shoal::python {
namespace {

constexpr std::chrono::milliseconds kLook{50}, kForStack{500};

int64_t NowNs() { return Now().time_since_epoch().count(); }

}  // namespace

CallWatch::CallWatch(std::string environment, std::chrono::duration<double> limit)
    : environment_(std::move(environment)), limit_(limit), caller_(pthread_self()) {
  const HeldSignals held;  // the new thread must not handle signals
  thread_ = std::thread([this] { Watch(); });
}

CallWatch::~CallWatch() {
  leave_ = true;
  thread_.join();
}

void CallWatch::Begin(const char* name) {
  name_.store(name, std::memory_order_relaxed);
  began_ns_.store(NowNs(), std::memory_order_release);
}

void CallWatch::End() { began_ns_.store(0, std::memory_order_release); }

void CallWatch::Watch() {
  // If the process was stopped (Ctrl-Z), it did not wait, so each look counts at most `most`
  // seconds.
  constexpr std::chrono::duration<double> most = 4 * kLook;
  std::chrono::duration<double> waited{};
  int64_t call = 0;
  SteadyTime looked = Now();
  while (!leave_) {
    SleepFor(kLook);
    const SteadyTime now = Now();
    const std::chrono::duration<double> since = now - std::exchange(looked, now);
    const int64_t began = began_ns_.load(std::memory_order_acquire);
    if (began == 0 || began != std::exchange(call, began)) waited = {};
    if (began == 0) continue;
    waited += std::min(since, most);
    if (waited > limit_) EndProcess(name_.load(std::memory_order_relaxed));
  }
}

void CallWatch::EndProcess(const char* name) {
  pthread_kill(caller_, SIGUSR2);
  SleepFor(kForStack);
  const std::string line = fmt::format(
      "shoal-actor: error: environment {}: {} did not return within env.step_timeout = {} s; its "
      "Python stack is in this log\n",
      environment_, name, limit_.count());
  // stdio is not used, because the stuck call may hold its locks.
  if (write(STDERR_FILENO, line.data(), line.size()) < 0) _exit(2);
  _exit(1);
}

}  // namespace shoal::python
