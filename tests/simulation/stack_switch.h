// SPDX-License-Identifier: Apache-2.0
// Stacks of simulated threads, and the switch between them. On x86-64 a switch is a few
// instructions; elsewhere it is swapcontext, which asks the kernel for the signal mask twice.
#pragma once

#include <cstddef>
#include <memory>

namespace shoal::simulation {

// Memory of a stack, with an inaccessible page below it, so that an overflow is a fault. The memory
// of a destroyed Stack is reused by later ones. One thread.
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

// A point at which execution can continue: the start of a function, or a call of SwitchTo.
class StackSwitch {
 public:
  // The context of a thread that calls SwitchTo.
  StackSwitch();
  // The beginning of `function`, which never returns, on `stack`.
  StackSwitch(const Stack& stack, void (*function)());
  ~StackSwitch();
  StackSwitch(const StackSwitch&) = delete;
  StackSwitch& operator=(const StackSwitch&) = delete;

  // Continues at `other`. Returns when another context switches back to this one.
  void SwitchTo(StackSwitch& other);

 private:
  struct Context;
  const std::unique_ptr<Context> context_;
};

}  // namespace shoal::simulation
