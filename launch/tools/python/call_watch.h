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

// Owns a thread. Calls are made by one thread, one at a time.
class CallWatch {
 public:
  // `environment`: name of the environment in the error line. If a call takes longer than `limit`,
  // the caller gets SIGUSR2, on which faulthandler writes the Python stack (set up by
  // shoal_rl.actor). Then the watch writes the line and ends the process with exit code 1.
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
  std::thread thread_;  // last: uses the other members
};

}  // namespace shoal::python
