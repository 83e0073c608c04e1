// SPDX-License-Identifier: Apache-2.0
// Stacks of simulated threads, and the switch between them. On x86-64 a switch is a few
// instructions; elsewhere it is swapcontext, which asks the kernel for the signal mask twice.
#pragma once

#include <cstddef>
#include <memory>

namespace shoal::simulation {

// Memory of a stack, with a page below it that cannot be touched, so that an overflow is a fault.
// A later Stack uses the memory of a destroyed one again. One thread.
class Stack {
 public:
  Stack();
  ~Stack();
  Stack(const Stack&) = delete;
  Stack& operator=(const Stack&) = delete;

  char* begin() const;
  static size_t size();

 private:
  char* const memory_;
};

// A point at which execution goes on: of a function that has not begun, or of a SwitchTo.
class StackSwitch {
 public:
  // The place of the caller of SwitchTo.
  StackSwitch();
  // The beginning of `function`, which never returns, on `stack`.
  StackSwitch(const Stack& stack, void (*function)());
  ~StackSwitch();
  StackSwitch(const StackSwitch&) = delete;
  StackSwitch& operator=(const StackSwitch&) = delete;

  // Goes on at `other`. Returns when something switches back to this.
  void SwitchTo(StackSwitch& other);

 private:
  struct Context;
  const std::unique_ptr<Context> context_;
};

}  // namespace shoal::simulation
