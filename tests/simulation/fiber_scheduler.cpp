// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/fiber_scheduler.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "tests/simulation/stack_switch.h"

// The C++ run-time's account of exceptions in flight, which is the thread's: each fiber has its
// own.
namespace __cxxabiv1 {
struct __cxa_eh_globals;
extern "C" __cxa_eh_globals* __cxa_get_globals() noexcept;
}  // namespace __cxxabiv1

namespace shoal::simulation {
namespace {

constexpr SteadyTime kNever = SteadyTime::max();

struct ExceptionState {
  void* caught = nullptr;
  unsigned uncaught = 0;
};

ExceptionState& CurrentExceptions() {
  return *reinterpret_cast<ExceptionState*>(__cxxabiv1::__cxa_get_globals());
}

// The path of an open file; empty for memory without a name.
std::string PathOf(int descriptor) {
  std::error_code error;
  const auto path =
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error).string();
  return path.starts_with("/memfd:") ? "" : path;
}

// A mapping holds a file's lock for as long as a descriptor does.
void UnmapFiles(const std::set<std::string>& paths) {
  std::ifstream maps("/proc/self/maps");
  std::vector<std::pair<uintptr_t, uintptr_t>> found;
  for (std::string line; std::getline(maps, line);) {
    const size_t at = line.find('/');
    if (at == std::string::npos || !paths.contains(line.substr(at))) continue;
    const size_t dash = line.find('-');
    found.emplace_back(std::stoull(line.substr(0, dash), nullptr, 16),
                       std::stoull(line.substr(dash + 1), nullptr, 16));
  }
  for (const auto& [begin, end] : found) munmap(reinterpret_cast<void*>(begin), end - begin);
}

FiberScheduler* entered = nullptr;  // for Enter, which can take no argument of this size

}  // namespace

struct FiberScheduler::Fiber {
  uint64_t id = 0;
  ThreadGroup* group = nullptr;
  std::function<void()> body;
  Stack stack;
  StackSwitch context{stack, &FiberScheduler::Enter};
  ExceptionState exceptions;
  bool runnable = true;
  SteadyTime wake = kNever;         // when it runs at the latest
  SteadyTime not_before{};          // of a paused process
  const void* condition = nullptr;  // that it waits for
  bool notified = false;
  bool ended = false;
};

struct FiberScheduler::Main {
  StackSwitch context;
  ExceptionState exceptions;
};

FiberScheduler::FiberScheduler(uint64_t seed, int64_t wall_time_ns)
    : random_(seed), wall_start_ns_(wall_time_ns), main_(std::make_unique<Main>()) {}

FiberScheduler::~FiberScheduler() {
  // Fibers that have not ended own what cannot be destroyed: their stacks stay, too.
  for (auto* fibers : {&fibers_, &killed_}) {
    for (std::unique_ptr<Fiber>& fiber : *fibers) {
      if (!fiber->ended) (void)fiber.release();
    }
  }
}

uint64_t FiberScheduler::StartIn(ThreadGroup* group, std::function<void()> body) {
  auto fiber = std::make_unique<Fiber>();
  fiber->id = next_id_++;
  fiber->group = group;
  fiber->body = std::move(body);
  fibers_.push_back(std::move(fiber));
  return fibers_.back()->id;
}

uint64_t FiberScheduler::Start(std::function<void()> body) {
  CHECK(running_ != nullptr) << "outside of fibers it is StartIn";
  return StartIn(running_->group, std::move(body));
}

void FiberScheduler::Enter() {
  FiberScheduler* self = entered;
  Fiber* fiber = self->running_;
  fiber->body();
  fiber->body = nullptr;
  fiber->ended = true;
  self->Notify(fiber, /*all=*/true);  // who joins it
  self->Block(kNever);
  CHECK(false) << "an ended fiber runs";
}

void FiberScheduler::RunUntil(SteadyTime until) {
  CHECK(running_ == nullptr);
  while (now_ < until) {
    std::erase_if(fibers_, [](const auto& fiber) { return fiber->ended; });
    if (fibers_.empty()) return;
    if (Fiber* fiber = Choose()) {
      Resume(fiber);
    } else {
      now_ = std::min(until, std::max(now_, EarliestWake()));
    }
  }
}

FiberScheduler::Fiber* FiberScheduler::Choose() {
  runnable_.clear();
  for (const auto& fiber : fibers_) {
    const bool awake = fiber->runnable || fiber->notified || fiber->wake <= now_;
    if (!fiber->ended && awake && fiber->not_before <= now_) runnable_.push_back(fiber.get());
  }
  if (runnable_.empty()) return nullptr;
  return runnable_[random_.Below(runnable_.size())];
}

SteadyTime FiberScheduler::EarliestWake() const {
  SteadyTime earliest = kNever;
  for (const auto& fiber : fibers_) {
    if (fiber->ended) continue;
    const SteadyTime wake = fiber->runnable || fiber->notified ? now_ : fiber->wake;
    earliest = std::min(earliest, std::max(wake, fiber->not_before));
  }
  return earliest;
}

void FiberScheduler::Resume(Fiber* fiber) {
  trace_ = HashWords({trace_, fiber->id, static_cast<uint64_t>(now_.time_since_epoch().count())});
  ++switches_;
  running_ = fiber;
  entered = this;
  fiber->runnable = false;
  Scheduler* const outer = Scheduler::Current();
  Scheduler::SetCurrent(this);
  const ThreadGroup::Bound bound(fiber->group);
  main_->exceptions = std::exchange(CurrentExceptions(), fiber->exceptions);
  main_->context.SwitchTo(fiber->context);
  fiber->exceptions = std::exchange(CurrentExceptions(), main_->exceptions);
  Scheduler::SetCurrent(outer);
  running_ = nullptr;
  if (slow_.empty()) return;
  const auto slow = slow_.find(fiber->group);
  if (slow == slow_.end()) return;
  if (now_ < slow->second.until) {
    fiber->not_before = std::max(fiber->not_before, now_ + slow->second.turn);
  } else {
    slow_.erase(slow);
  }
}

void FiberScheduler::Block(SteadyTime wake) {
  Fiber* fiber = running_;
  CHECK(fiber != nullptr) << "a wait outside of fibers";
  fiber->wake = wake;
  fiber->context.SwitchTo(main_->context);
  fiber->wake = kNever;
}

bool FiberScheduler::WaitFor(const void* condition, SteadyTime deadline) {
  Fiber* fiber = running_;
  CHECK(fiber != nullptr) << "a wait outside of fibers";
  fiber->condition = condition;
  fiber->notified = false;
  Block(deadline);
  fiber->condition = nullptr;
  return std::exchange(fiber->notified, false);
}

void FiberScheduler::Pause(ThreadGroup* group, SteadyTime time) {
  for (const auto& fiber : fibers_) {
    if (fiber->group == group) fiber->not_before = std::max(fiber->not_before, time);
  }
}

void FiberScheduler::Stall(ThreadGroup* group, uint64_t which, SteadyTime time) {
  std::vector<Fiber*> all;
  for (const auto& fiber : fibers_) {
    if (fiber->group == group && !fiber->ended) all.push_back(fiber.get());
  }
  if (all.empty()) return;
  Fiber* const fiber = all[which % all.size()];
  fiber->not_before = std::max(fiber->not_before, time);
}

void FiberScheduler::SlowDown(ThreadGroup* group, SteadyTime::duration turn, SteadyTime time) {
  slow_[group] = {turn, time};
}

void FiberScheduler::Kill(ThreadGroup* group) {
  CHECK(running_ == nullptr || running_->group != group) << "a process cannot kill itself";
  for (auto& fiber : fibers_) {
    if (fiber->group != group || fiber->ended) continue;
    killed_.push_back(std::move(fiber));
  }
  std::erase(fibers_, nullptr);
  std::set<std::string> paths;
  std::erase_if(files_, [&](const auto& file) {
    if (file.second != group) return false;
    paths.insert(PathOf(file.first));
    close(file.first);
    return true;
  });
  UnmapFiles(paths);
}

int FiberScheduler::Alive(const ThreadGroup* group) const {
  return static_cast<int>(std::ranges::count_if(
      fibers_, [&](const auto& fiber) { return fiber->group == group && !fiber->ended; }));
}

void FiberScheduler::OnOpened(int descriptor) { files_[descriptor] = ThreadGroup::Current(); }

void FiberScheduler::OnClosed(int descriptor) { files_.erase(descriptor); }

SteadyTime FiberScheduler::Now() {
  if (running_ != nullptr) now_ += kPerLook;
  return now_;
}

int64_t FiberScheduler::WallTimeNs() {
  return wall_start_ns_ + wall_offset_ns_ +
         std::chrono::nanoseconds(Now().time_since_epoch()).count();
}

void FiberScheduler::SleepUntil(SteadyTime time) { Block(std::max(time, now_)); }

void FiberScheduler::Lock(bool* held) {
  while (*held) WaitFor(held, kNever);
  *held = true;
}

void FiberScheduler::Unlock(bool* held) {
  CHECK(*held);
  *held = false;
  Notify(held, /*all=*/false);
}

bool FiberScheduler::Wait(const void* condition, bool* held, SteadyTime deadline) {
  Unlock(held);
  const bool notified = WaitFor(condition, deadline);
  Lock(held);
  return notified;
}

void FiberScheduler::Notify(const void* condition, bool all) {
  runnable_.clear();
  for (const auto& fiber : fibers_) {
    if (fiber->condition == condition && !fiber->notified) runnable_.push_back(fiber.get());
  }
  if (runnable_.empty()) return;
  if (!all) {
    runnable_[random_.Below(runnable_.size())]->notified = true;
    return;
  }
  for (Fiber* fiber : runnable_) fiber->notified = true;
}

FiberScheduler::Fiber* FiberScheduler::Find(uint64_t id) {
  const auto found = std::ranges::find(fibers_, id, [](const auto& fiber) { return fiber->id; });
  return found == fibers_.end() ? nullptr : found->get();
}

bool FiberScheduler::Ended(uint64_t thread) {
  const Fiber* fiber = Find(thread);
  return fiber == nullptr || fiber->ended;
}

void FiberScheduler::Join(uint64_t thread) {
  while (!Ended(thread)) WaitFor(Find(thread), kNever);
}

}  // namespace shoal::simulation
