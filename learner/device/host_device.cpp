// SPDX-License-Identifier: Apache-2.0
#include "learner/device/host_device.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>
#include <variant>

#include "common/base/check.h"
#include "learner/device/host_products.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#define SHOAL_FORBID(address, bytes) ASAN_POISON_MEMORY_REGION(address, bytes)
#define SHOAL_ALLOW(address, bytes) ASAN_UNPOISON_MEMORY_REGION(address, bytes)
#else
#define SHOAL_FORBID(address, bytes) static_cast<void>(address)
#define SHOAL_ALLOW(address, bytes) static_cast<void>(address)
#endif

namespace shoal::learner::device {
namespace {

constexpr std::align_val_t kAlignment{256};
constexpr int64_t kGuardBytes = 256;
constexpr std::byte kGuardByte{0xa5}, kInvalid{0xff};  // f32, bf16 and double of 0xff are NaN

// Returns memory with guards before and after it.
std::byte* NewGuarded(int64_t bytes) {
  auto* start =
      static_cast<std::byte*>(::operator new(size_t(bytes + 2 * kGuardBytes), kAlignment));
  std::byte* memory = start + kGuardBytes;
  std::fill_n(start, kGuardBytes, kGuardByte);
  std::fill_n(memory, bytes, kInvalid);
  std::fill_n(memory + bytes, kGuardBytes, kGuardByte);
  SHOAL_FORBID(start, size_t(kGuardBytes));
  SHOAL_FORBID(memory + bytes, size_t(kGuardBytes));
  return memory;
}

void CheckGuarded(const std::byte* memory, int64_t bytes) {
  const auto is_whole = [](const std::byte* guard) {
    SHOAL_ALLOW(guard, size_t(kGuardBytes));
    const bool whole =
        std::all_of(guard, guard + kGuardBytes, [](std::byte b) { return b == kGuardByte; });
    SHOAL_FORBID(guard, size_t(kGuardBytes));
    return whole;
  };
  CHECK(is_whole(memory - kGuardBytes)) << "a write before an allocation of " << bytes << " bytes";
  CHECK(is_whole(memory + bytes)) << "a write behind an allocation of " << bytes << " bytes";
}

void DeleteGuarded(std::byte* memory, int64_t bytes) {
  CheckGuarded(memory, bytes);
  std::byte* start = memory - kGuardBytes;
  SHOAL_ALLOW(start, size_t(bytes + 2 * kGuardBytes));
  ::operator delete(start, kAlignment);
}

}  // namespace

class HostDevice::HostEvent final : public Event {
 public:
  const std::shared_ptr<Marks>& marks() const { return marks_; }

 private:
  // Shared with submitted work, which may outlive the event.
  std::shared_ptr<Marks> marks_ = std::make_shared<Marks>();
};

class HostDevice::HostRecording final : public Recording {
 public:
  explicit HostRecording(const CommandList& commands) : commands_(commands) {}
  const CommandList& commands() const { return commands_; }

 private:
  const CommandList commands_;
};

HostDevice::HostDevice() : HostDevice(Options()) {}

HostDevice::HostDevice(const Options& options) : options_(options) {
  info_.name = "host memory";
  info_.memory_bytes = int64_t{1} << 34;
  info_.f32_channels = options.f32_channels;
  info_.bf16_channels = options.bf16_channels;
}

HostDevice::~HostDevice() {
  CHECK(memory_.empty()) << memory_.size() << " allocations were not freed";
  CHECK(host_memory_.empty()) << host_memory_.size() << " host allocations were not freed";
  CHECK(registered_.empty()) << registered_.size() << " ranges are still registered";
}

void* HostDevice::Allocate(int64_t bytes) {
  CHECK(bytes > 0) << bytes;
  std::byte* memory = NewGuarded(bytes);
  memory_[memory] = bytes;
  allocated_ += bytes;
  return memory;
}

void HostDevice::Free(void* memory) {
  if (memory == nullptr) return;
  Finish();
  const auto found = memory_.find(static_cast<std::byte*>(memory));
  CHECK(found != memory_.end()) << "no memory of this device";
  DeleteGuarded(found->first, found->second);
  allocated_ -= found->second;
  memory_.erase(found);
}

void* HostDevice::AllocateHost(int64_t bytes) {
  CHECK(bytes > 0) << bytes;
  std::byte* memory = NewGuarded(bytes);
  host_memory_[memory] = bytes;
  return memory;
}

void HostDevice::FreeHost(void* memory) {
  if (memory == nullptr) return;
  Finish();
  const auto found = host_memory_.find(static_cast<std::byte*>(memory));
  CHECK(found != host_memory_.end()) << "no host memory of this device";
  DeleteGuarded(found->first, found->second);
  host_memory_.erase(found);
}

bool HostDevice::RegisterHost(const void* memory, int64_t bytes) {
  if (!options_.registers) return false;
  CHECK(registered_.emplace(memory, bytes).second) << "already registered";
  return true;
}

void HostDevice::UnregisterHost(const void* memory) {
  CHECK(registered_.erase(memory) == 1) << "not registered";
}

void HostDevice::CheckRange(const void* memory, int64_t bytes) const {
  const auto* first = static_cast<const std::byte*>(memory);
  auto after = memory_.upper_bound(const_cast<std::byte*>(first));
  CHECK(after != memory_.begin()) << "no memory of this device";
  const auto& [begin, size] = *std::prev(after);
  CHECK(bytes >= 0 && first + bytes <= begin + size)
      << bytes << " bytes from byte " << first - begin << " of " << size;
}

void HostDevice::CopyIn(Lane lane, const void* host, int64_t bytes, void* device) {
  CheckRange(device, bytes);
  LaneOf(lane).push_back([=] { std::memcpy(device, host, size_t(bytes)); });
}

void HostDevice::CopyOut(Lane lane, const void* device, int64_t bytes, void* host) {
  CheckRange(device, bytes);
  LaneOf(lane).push_back([=] { std::memcpy(host, device, size_t(bytes)); });
}

void HostDevice::Run(const CommandList& commands) {
  LaneOf(Lane::kCommands).push_back([this, commands] {
    for (const Command& command : commands.commands()) RunCommand(command);
  });
}

std::unique_ptr<Recording> HostDevice::Record(const CommandList& commands) {
  return std::make_unique<HostRecording>(commands);
}

void HostDevice::Replay(const Recording& recording) {
  Run(dynamic_cast<const HostRecording&>(recording).commands());
}

std::unique_ptr<Event> HostDevice::NewEvent() { return std::make_unique<HostEvent>(); }

void HostDevice::Mark(Lane lane, Event* event) {
  const std::shared_ptr<Marks>& marks = dynamic_cast<HostEvent*>(event)->marks();
  marks->lane = lane;
  const int64_t mark = ++marks->submitted;
  // Marks of different lanes may be reached in any order.
  LaneOf(lane).push_back([marks, mark] { marks->reached = std::max(marks->reached, mark); });
}

void HostDevice::Await(Lane lane, const Event& event) {
  const std::shared_ptr<Marks>& marks = dynamic_cast<const HostEvent&>(event).marks();
  LaneOf(lane).push_back([this, marks, lane_of_mark = marks->lane, mark = marks->submitted] {
    RunUntil(lane_of_mark, *marks, mark);
  });
}

void HostDevice::Wait(const Event& event) {
  const std::shared_ptr<Marks>& marks = dynamic_cast<const HostEvent&>(event).marks();
  RunUntil(marks->lane, *marks, marks->submitted);
}

void HostDevice::RunNext(Lane lane) {
  std::deque<Work>& work = LaneOf(lane);
  CHECK(!work.empty()) << "an event waits for work that was not submitted";
  const Work next = std::move(work.front());
  work.pop_front();
  next();
}

void HostDevice::RunUntil(Lane lane, const Marks& marks, int64_t mark) {
  while (marks.reached < mark) RunNext(lane);
}

void HostDevice::Finish() {
  const Lane second = options_.first == Lane::kCommands ? Lane::kCopies : Lane::kCommands;
  while (!LaneOf(options_.first).empty()) RunNext(options_.first);
  while (!LaneOf(second).empty()) RunNext(second);
  CheckGuards();
}

void HostDevice::CheckGuards() const {
  for (const auto& [memory, bytes] : memory_) CheckGuarded(memory, bytes);
  for (const auto& [memory, bytes] : host_memory_) CheckGuarded(memory, bytes);
}

namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace

void HostDevice::RunCommand(const Command& command) {
  std::visit(Overloaded{[&](const kernels::Kernel& kernel) {
                          std::visit(
                              [&](const auto& one) { kernels::RunOnHost(one, options_.order); },
                              kernel);
                        },
                        [&](const Clear& clear) {
                          CheckRange(clear.memory, clear.bytes);
                          std::memset(clear.memory, 0, size_t(clear.bytes));
                        },
                        [&](const Copy& copy) {
                          CheckRange(copy.from, copy.bytes);
                          CheckRange(copy.to, copy.bytes);
                          std::memcpy(copy.to, copy.from, size_t(copy.bytes));
                        },
                        [](const Product& product) { ComputeProduct(product); },
                        [](const ConvolutionForward& forward) { ComputeForward(forward); },
                        [](const ConvolutionData& data) { ComputeData(data); },
                        [](const ConvolutionWeights& weights) { ComputeWeights(weights); }},
             command);
}

}  // namespace shoal::learner::device
