// SPDX-License-Identifier: Apache-2.0
// Ends the process if a call of the user's code does not return. The call may block forever in
// Python or in C, with or without Python's global lock (GIL).
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace shoal::python {

// Owns a thread. One other thread makes the calls, one at a time.
class CallWatch {
 public:
  // `environment`: name of the environment in the error line. If a call takes longer than `limit`,
  // the watch sends SIGUSR2 to the calling thread; Python's faulthandler, set up by shoal_rl.actor,
  // then writes the Python stack. After that the watch writes the error line and ends the process
  // with exit code 1.
  CallWatch(std::string environment, std::chrono::duration<double> limit);
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

  // Marks a call as active while the object lives. `name`: a string literal.
  class Call {
   public:
    Call(CallWatch& watch, const char* name) : watch_(watch) { watch_.Begin(name); }
    ~Call() { watch_.End(); }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    CallWatch& watch_;
  };

 private:
  void Begin(const char* name);
  void End();
  void Watch();
  [[noreturn]] void EndProcess(const char* name);

  const std::string environment_;
  const std::chrono::duration<double> limit_;
  const pthread_t caller_;
  std::atomic<int64_t> began_ns_{0};  // steady clock; 0 = no call
  std::atomic<const char*> name_{nullptr};
  std::atomic<bool> leave_{false};
  std::thread thread_;  // the last member, because the thread uses the other members
};

}  // namespace shoal::python
