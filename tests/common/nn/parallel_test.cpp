// SPDX-License-Identifier: Apache-2.0
#include "common/nn/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

#include "common/nn/linear.h"
#include "common/nn/parameter_set.h"
#include "common/nn/precision.h"
#include "common/nn/rows.h"
#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceForAnySizeAndNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    const ThreadScope scope(threads);
    for (const int n : {0, 1, 2, 3, 7, 100}) {
      auto visits = std::vector<int>(size_t(n));
      std::atomic<int> ranges = 0;
      ParallelFor(n, [&](int begin, int end) {
        ++ranges;
        for (int i = begin; i < end; ++i) ++visits[size_t(i)];
      });
      EXPECT_EQ(visits, std::vector<int>(size_t(n), 1));
      EXPECT_LE(ranges, threads);
    }
  }
}

TEST(ParallelFor, RunsOnAsManyThreadsAsTheScopeAllows) {
  const ThreadScope scope(3);
  std::atomic<int> ranges = 0;
  ParallelFor(300, [&](int, int) { ++ranges; });
  EXPECT_EQ(ranges, 3);
}

TEST(ThreadScope, HoldsForItsOwnThreadAndPutsTheFormerSizeBack) {
  const ThreadScope outer(2);
  std::atomic<int> ranges = 0;
  {
    const ThreadScope inner(4);
    std::thread([] { const ThreadScope other(1); }).join();
    ParallelFor(400, [&](int, int) { ++ranges; });
    EXPECT_EQ(ranges, 4);
  }
  ranges = 0;
  ParallelFor(400, [&](int, int) { ++ranges; });
  EXPECT_EQ(ranges, 2);
}

// Handles SIGUSR1 during this object's lifetime.
class Handler {
 public:
  explicit Handler(void (*handle)(int)) {
    struct sigaction action {};
    action.sa_handler = handle;
    sigaction(SIGUSR1, &action, &former_);
  }
  ~Handler() { sigaction(SIGUSR1, &former_, nullptr); }
  Handler(const Handler&) = delete;
  Handler& operator=(const Handler&) = delete;

 private:
  struct sigaction former_ {};
};

bool Blocked(int signal) {
  sigset_t mask;
  pthread_sigmask(SIG_BLOCK, nullptr, &mask);
  return sigismember(&mask, signal) == 1;
}

std::atomic<int> handled = 0;

// Runs on a thread of its own, whose pool starts in the scope: the main thread's pool may hold
// threads that another test started without one.
TEST(ThreadScope, HoldsSignalsForItsThreadAndItsPool) {
  handled = 0;
  const Handler handler([](int) { ++handled; });
  std::thread([] {
    {
      const ThreadScope outer(7);
      const ThreadScope inner(7);
      pthread_kill(pthread_self(), SIGUSR1);
      std::atomic<int> ranges = 0;
      ParallelFor(70, [&](int, int) {
        EXPECT_TRUE(Blocked(SIGUSR1) && Blocked(SIGHUP) && Blocked(SIGINT));
        EXPECT_FALSE(Blocked(SIGSEGV)) << "a fault must keep its handler";
        ++ranges;
      });
      EXPECT_EQ(ranges, 7);
      EXPECT_EQ(handled, 0);
    }
    EXPECT_EQ(handled, 1);
    EXPECT_FALSE(Blocked(SIGUSR1));
  }).join();
}

// Bounds of the stack of the thread that computes, and how many handlers ran beside it.
std::atomic<const char*> stack_begin, stack_end;
std::atomic<int> beside_the_stack = 0;

void NoteStack(int) {
  const char* frame = static_cast<const char*>(__builtin_frame_address(0));
  if (frame < stack_begin || frame >= stack_end) ++beside_the_stack;
  ++handled;
}

// Without AVX-512, oneDNN's products with many inputs use the stack pointer for their buffer.
TEST(ThreadScope, AHandlerNeverRunsOnTheBufferOfAProduct) {
  constexpr int kProductRows = 256, kInputs = 1024, kOutputs = 1024, kSignals = 500;
  handled = beside_the_stack = 0;
  const Handler handler(NoteStack);
  std::atomic<bool> ready = false, done = false;
  std::thread computing([&] {
    pthread_attr_t attributes;
    void* begin = nullptr;
    size_t bytes = 0;
    pthread_getattr_np(pthread_self(), &attributes);
    pthread_attr_getstack(&attributes, &begin, &bytes);
    pthread_attr_destroy(&attributes);
    stack_begin = static_cast<const char*>(begin);
    stack_end = stack_begin + bytes;
    ParameterSet parameters({{"fc.weight", {kOutputs, kInputs}}, {"fc.bias", {kOutputs}}},
                            ParameterSet::Use::kTraining);
    Rows source(kProductRows, kInputs, Precision::kF32),
        gradient(kProductRows, kInputs, Precision::kF32);
    const auto build = [&] {
      const ThreadScope scope(1);
      return std::make_unique<Linear>(LayerContext{&parameters, Precision::kF32, kProductRows, true,
                                                   std::make_shared<Scratchpad>()},
                                      "fc", source.compute(), gradient.f32());
    };
    const std::unique_ptr<Linear> linear = build();
    ready = true;
    while (!done) {
      const ThreadScope scope(1);
      linear->Refresh();
      linear->Forward();
      linear->Backward({});
    }
  });
  while (!ready) std::this_thread::yield();
  for (int i = 0; i < kSignals; ++i) {
    pthread_kill(computing.native_handle(), SIGUSR1);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  done = true;
  computing.join();
  EXPECT_GT(handled, 0);
  EXPECT_EQ(beside_the_stack, 0) << "of " << handled;
}

TEST(SetThreads, IsTheCallingThreadsOwn) {
  SetThreads(3);
  int seen = 0;
  std::thread([&] {
    seen = Threads();
    SetThreads(2);
  }).join();
  EXPECT_EQ(seen, 1);
  EXPECT_EQ(Threads(), 3);
}

}  // namespace
}  // namespace shoal::nn
