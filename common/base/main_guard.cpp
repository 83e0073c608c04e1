// SPDX-License-Identifier: Apache-2.0
#include "common/base/main_guard.h"

#include <fmt/core.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/base/one_line.h"
#include "common/base/stop.h"

namespace shoal {
namespace {

// A reason may quote foreign text, so it is reduced to one line of readable length.
constexpr size_t kReasonBytes = 1000;

std::string ReasonLine(const std::string& program, const char* what, const char* reason) {
  return fmt::format("{}: {}: {}", program, what, Shortened(OneLine(reason), kReasonBytes));
}

// Returns only in process 1 of a container, which the kernel does not end. The exit code is then
// the one that a shell reports for a death by the signal.
int DieBy(int signal) {
  std::fflush(nullptr);  // a death by a signal writes no buffers
  std::signal(signal, SIG_DFL);
  sigset_t unblocked;
  sigemptyset(&unblocked);
  sigaddset(&unblocked, signal);
  pthread_sigmask(SIG_UNBLOCK, &unblocked, nullptr);
  raise(signal);
  return 128 + signal;
}

}  // namespace

int GuardBody(const std::string& program, const std::function<int()>& body,
              const std::function<void(const std::string& line)>& say) {
  try {
    return body();
  } catch (const Interrupted& e) {
    say(ReasonLine(program, "interrupted", e.what()));
    return kInterruptedExit;
  } catch (const Error& e) {
    say(ReasonLine(program, "error", e.what()));
    return e.exit_code();
  } catch (const std::exception& e) {
    say(ReasonLine(program, "error", e.what()));
    return 1;
  }
}

int GuardMain(const char* program, const std::function<int()>& body) {
  NoteUmask();
  const int value = GuardBody(
      program, body, [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
  const int signal = StopSignal();
  const bool in_order = value == 0 || value == kInterruptedExit;
  return signal != 0 && in_order ? DieBy(signal) : value;
}

}  // namespace shoal
