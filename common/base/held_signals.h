// SPDX-License-Identifier: Apache-2.0
// A scope in which the calling thread handles no signals.
#pragma once

#include <csignal>

namespace shoal {

// While an object lives, signals wait that other programs, the terminal or timers send to this
// thread. Threads that are created meanwhile inherit this, for their whole life. Faults of the
// thread itself (SIGSEGV and the like) are not affected. The destructor restores the earlier state;
// then the handlers of waiting signals run. A signal to the process goes to another thread that
// accepts it, if there is one. Objects may be nested. The thread that creates an object destroys
// it.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t held;
    sigfillset(&held);
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS}) {
      sigdelset(&held, fault);
    }
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace shoal
