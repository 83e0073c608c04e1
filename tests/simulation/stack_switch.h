// SPDX-License-Identifier: Apache-2.0
// Stacks of simulated threads, and the switch between them. On x86-64 a switch takes a few
// instructions. Other machines use swapcontext, which makes two system calls for the signal mask.
#pragma once

#include <cstddef>
#include <memory>

namespace shoal::simulation {

// Memory of a stack. The page below the stack is inaccessible, so that an overflow is a fault.
// Later Stacks reuse the memory of a destroyed Stack. One thread.
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
  // Context of the thread that calls SwitchTo.
  StackSwitch();
  // Context at the beginning of `function`, which runs on `stack` and never returns.
  StackSwitch(const Stack& stack, void (*function)());
  ~StackSwitch();
  StackSwitch(const StackSwitch&) = delete;
  StackSwitch& operator=(const StackSwitch&) = delete;

  // Continues at `other`. Returns when another context switches back to this context.
  void SwitchTo(StackSwitch& other);

 private:
  struct Context;
  const std::unique_ptr<Context> context_;
};

}  // namespace shoal::simulation
