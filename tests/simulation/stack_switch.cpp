// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/stack_switch.h"

#include <sys/mman.h>

#include <cstdint>
#include <vector>

#include "common/base/check.h"

// The sanitizers follow swapcontext.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SHOAL_SWITCHES_IN_PLACE 1
#else
#include <ucontext.h>
#endif

#ifdef SHOAL_SWITCHES_IN_PLACE
// Pushes the callee-saved registers, stores the stack pointer in *from, and makes `to` the new
// stack pointer.
extern "C" void ShoalSwitchStack(void** from, void* to);
asm(R"(
.pushsection .text
.globl ShoalSwitchStack
.type ShoalSwitchStack, @function
ShoalSwitchStack:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  ret
.size ShoalSwitchStack, . - ShoalSwitchStack
.popsection
)");
#endif

namespace shoal::simulation {
namespace {

constexpr size_t kStackBytes = size_t{1} << 20;
constexpr size_t kGuardBytes = 4096;

std::vector<char*>& UnusedStacks() {
  static std::vector<char*> unused;
  return unused;
}

// Untouched pages cost nothing.
char* TakeStack() {
  if (!UnusedStacks().empty()) {
    char* const memory = UnusedStacks().back();
    UnusedStacks().pop_back();
    return memory;
  }
  void* const memory = mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  CHECK(memory != MAP_FAILED);
  CHECK(mprotect(memory, kGuardBytes, PROT_NONE) == 0);
  return static_cast<char*>(memory);
}

}  // namespace

Stack::Stack() : memory_(TakeStack()) {}

Stack::~Stack() {
#ifdef SHOAL_SWITCHES_IN_PLACE
  UnusedStacks().push_back(memory_);
#else
  munmap(memory_, kStackBytes);  // the address sanitizer remembers the frames on it
#endif
}

char* Stack::begin() const { return memory_ + kGuardBytes; }

size_t Stack::size() { return kStackBytes - kGuardBytes; }

#ifdef SHOAL_SWITCHES_IN_PLACE

struct StackSwitch::Context {
  void* at = nullptr;  // the stack pointer
};

StackSwitch::StackSwitch(const Stack& stack, void (*function)())
    : context_(std::make_unique<Context>()) {
  constexpr size_t kRegisters = 6;
  // From the top: the end of the chain of callers, where a call leaves it (16 n + 8), `function`,
  // and six registers.
  auto* const top = reinterpret_cast<uintptr_t*>(stack.begin() + Stack::size()) - 3;
  top[0] = 0;
  top[-1] = reinterpret_cast<uintptr_t>(function);
  for (size_t i = 0; i < kRegisters; ++i) *(top - 2 - i) = 0;
  context_->at = top - 1 - kRegisters;
}

void StackSwitch::SwitchTo(StackSwitch& other) {
  ShoalSwitchStack(&context_->at, other.context_->at);
}

#else

struct StackSwitch::Context {
  ucontext_t at{};
};

StackSwitch::StackSwitch(const Stack& stack, void (*function)())
    : context_(std::make_unique<Context>()) {
  CHECK(getcontext(&context_->at) == 0);
  context_->at.uc_stack.ss_sp = stack.begin();
  context_->at.uc_stack.ss_size = Stack::size();
  context_->at.uc_link = nullptr;
  makecontext(&context_->at, function, 0);
}

void StackSwitch::SwitchTo(StackSwitch& other) {
  CHECK(swapcontext(&context_->at, &other.context_->at) == 0);
}

#endif

StackSwitch::StackSwitch() : context_(std::make_unique<Context>()) {}

StackSwitch::~StackSwitch() = default;

}  // namespace shoal::simulation
