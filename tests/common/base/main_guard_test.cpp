// SPDX-License-Identifier: Apache-2.0
#include "common/base/main_guard.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "common/base/interrupted.h"
#include "common/base/stop.h"

namespace shoal {
namespace {

// A process whose body gets `signal` and ends with `value`.
[[noreturn]] void EndAfter(int signal, int value) {
  std::exit(GuardMain("p", [&] {
    InstallStopSignals();
    raise(signal);
    return value;
  }));
}

TEST(GuardMain, AProgramThatASignalEndedInOrderDiesByIt) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(EndAfter(signal, 0), testing::KilledBySignal(signal), "");
    EXPECT_EXIT(EndAfter(signal, kInterruptedExit), testing::KilledBySignal(signal), "");
  }
}

TEST(GuardMain, TheFirstOfSeveralSignalsCounts) {
  const auto twice = [] {
    std::exit(GuardMain("p", [] {
      InstallStopSignals();
      raise(SIGTERM);
      raise(SIGINT);
      return 0;
    }));
  };
  EXPECT_EXIT(twice(), testing::KilledBySignal(SIGTERM), "");
}

TEST(GuardMain, AFailureKeepsItsExitCodeAfterASignal) {
  EXPECT_EXIT(EndAfter(SIGINT, 1), testing::ExitedWithCode(1), "");
}

TEST(GuardMain, ARequestThatIsNoSignalLeavesTheValue) {
  const auto requested = [] {
    std::exit(GuardMain("p", [] {
      RequestStop();
      return kInterruptedExit;
    }));
  };
  EXPECT_EXIT(requested(), testing::ExitedWithCode(kInterruptedExit), "");
}

TEST(GuardMain, WhatWasInterruptedSaysSoAndDiesByTheSignal) {
  const auto interrupted = [] {
    std::exit(GuardMain("p", []() -> int {
      InstallStopSignals();
      raise(SIGINT);
      throw Interrupted("before anything was started");
    }));
  };
  EXPECT_EXIT(interrupted(), testing::KilledBySignal(SIGINT),
              "p: interrupted: before anything was started\n");
}

TEST(GuardMain, WhatWasPrintedIsWrittenBeforeTheSignal) {
  const auto prints = [] {
    std::exit(GuardMain("p", [] {
      InstallStopSignals();
      std::FILE* const buffered = fdopen(dup(STDERR_FILENO), "w");
      std::fputs("the last words", buffered);
      raise(SIGINT);
      return 0;
    }));
  };
  EXPECT_EXIT(prints(), testing::KilledBySignal(SIGINT), "the last words");
}

// A child of a thread that had blocked the signal inherits that.
TEST(GuardMain, ABlockedSignalIsUnblocked) {
  const auto blocked = [] {
    std::exit(GuardMain("p", [] {
      InstallStopSignals();
      raise(SIGINT);
      sigset_t set;
      sigemptyset(&set);
      sigaddset(&set, SIGINT);
      sigprocmask(SIG_BLOCK, &set, nullptr);
      return 0;
    }));
  };
  EXPECT_EXIT(blocked(), testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace shoal
