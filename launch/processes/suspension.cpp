// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/suspension.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>

namespace shoal::launch {
namespace {

// The signal handler uses these lock-free variables only.
std::array<std::atomic<pid_t>, 1024> children{};  // 0: free
std::atomic<int> suspensions{0}, refused{0};
std::atomic<int64_t> suspended_ns{0};
static_assert(std::atomic<pid_t>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free,
              "used in a signal handler");

void SignalChildren(int signal) {
  for (const std::atomic<pid_t>& child : children) {
    if (const pid_t pid = child.load(); pid > 0) kill(pid, signal);
  }
}

void OnSuspend(int) {
  const int error = errno;
  const SteadyTime from = Now();  // clock_gettime
  SignalChildren(SIGSTOP);
  raise(SIGSTOP);  // stops all threads; sent to this thread, so that it waits here for SIGCONT
  SignalChildren(SIGCONT);
  suspended_ns += std::chrono::nanoseconds(Now() - from).count();
  ++suspensions;
  errno = error;
}

void OnRefused(int) { ++refused; }

void Install(void (*handler)(int)) {
  struct sigaction action {};
  sigaction(SIGTSTP, nullptr, &action);
  if (action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTSTP, &action, nullptr);
}

}  // namespace

void SuspendWithChildren() { Install(OnSuspend); }
void RefuseSuspension() { Install(OnRefused); }

int Suspensions() { return suspensions; }
int RefusedSuspensions() { return refused; }

SteadyTime AwakeNow() { return Now() - std::chrono::nanoseconds(suspended_ns); }

void AddSuspended(pid_t child) {
  for (std::atomic<pid_t>& place : children) {
    pid_t free = 0;
    if (place.compare_exchange_strong(free, child)) return;
  }
}

void RemoveSuspended(pid_t child) {
  for (std::atomic<pid_t>& place : children) {
    pid_t taken = child;
    if (place.compare_exchange_strong(taken, 0)) return;
  }
}

}  // namespace shoal::launch
