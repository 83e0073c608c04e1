// SPDX-License-Identifier: Apache-2.0
#include "common/base/stop.h"

#include <csignal>

#include "common/base/thread_group.h"

namespace shoal {
namespace {

std::atomic<int> requests{0};
std::atomic<bool> hung_up{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "used in a signal handler");

void NoteSignal(int signal) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal, std::memory_order_relaxed);
}

void OnSignal(int signal) {
  NoteSignal(signal);
  RequestStop();
}

void OnHangUp(int signal) {
  NoteSignal(signal);
  hung_up.store(true, std::memory_order_relaxed);
}

}  // namespace

void InstallStopSignals() {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) {
    hang_up.sa_handler = OnHangUp;
    sigaction(SIGHUP, &hang_up, nullptr);
  }
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

void RequestStop() { requests.fetch_add(1, std::memory_order_relaxed); }
bool StopRequested() {
  if (ThreadGroup::Current() != nullptr) return StopRequests() > 0;
  return StopRequests() > 0 || hung_up.load(std::memory_order_relaxed);
}
int StopRequests() {
  if (const ThreadGroup* group = ThreadGroup::Current()) return group->StopRequests();
  return requests.load(std::memory_order_relaxed);
}
int StopSignal() { return first_signal.load(std::memory_order_relaxed); }

}  // namespace shoal
