// SPDX-License-Identifier: Apache-2.0
// Ends the process when a call of the user's code does not return: it may wait for ever, in Python
// or in C, with or without Python's lock.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace shoal::python {

// Owns a thread. Calls are of one thread, one at a time.
class CallWatch {
 public:
  // `environment` names it in the line that is left. A call that takes longer than `limit` gets
  // SIGUSR2, on which shoal_rl.actor has faulthandler write the Python stack; then a line is
  // written and the process ends with exit code 1.
  CallWatch(std::string environment, std::chrono::duration<double> limit);
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

  // A call of this name is under way while it lives; `name` is a literal.
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
  std::thread thread_;  // last: it uses the others
};

}  // namespace shoal::python
