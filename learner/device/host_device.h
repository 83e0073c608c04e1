// SPDX-License-Identifier: Apache-2.0
// A device in host memory, for tests and for sanitizers: it needs no card, and it finds mistakes
// that a card would hide.
//
//   - Memory that was just allocated holds invalid numbers (NaN).
//   - Bytes before and after each allocation are guarded. Under the address sanitizer, an access to
//     them ends the program at once; otherwise Free and Finish CHECK that they did not change.
//   - Copies and fills CHECK that the device's side is one allocation.
//   - Work runs as late as possible: when the host waits for it. An input that the host changes too
//     early and a missing Await therefore change results.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>

#include "learner/device/commands.h"
#include "learner/device/device.h"
#include "learner/device/kernels/host_block.h"

namespace shoal::learner::device {

class HostDevice final : public Device {
 public:
  struct Options {
    kernels::HostOrder order = kernels::HostOrder::kForward;  // of blocks and threads
    Lane first = Lane::kCommands;                             // the lane that Finish runs first
    int f32_channels = 1, bf16_channels = 1;
    bool registers = true;  // whether RegisterHost prepares memory
  };

  HostDevice();
  explicit HostDevice(const Options& options);
  HostDevice(const HostDevice&) = delete;
  HostDevice& operator=(const HostDevice&) = delete;
  // CHECKs that all memory was freed.
  ~HostDevice() override;

  const DeviceInfo& info() const override { return info_; }
  int64_t FreeMemory() const override { return info_.memory_bytes - allocated_; }
  // Bytes that are allocated on the device.
  int64_t allocated() const { return allocated_; }
  // Pieces of work that were submitted and have not run yet.
  size_t waiting() const { return lanes_[0].size() + lanes_[1].size(); }

  void* Allocate(int64_t bytes) override;
  void Free(void* memory) override;
  void* AllocateHost(int64_t bytes) override;
  void FreeHost(void* memory) override;
  bool RegisterHost(const void* memory, int64_t bytes) override;
  void UnregisterHost(const void* memory) override;

  void CopyIn(Lane lane, const void* host, int64_t bytes, void* device) override;
  void CopyOut(Lane lane, const void* device, int64_t bytes, void* host) override;

  void Run(const CommandList& commands) override;
  std::unique_ptr<Recording> Record(const CommandList& commands) override;
  void Replay(const Recording& recording) override;

  std::unique_ptr<Event> NewEvent() override;
  void Mark(Lane lane, Event* event) override;
  void Await(Lane lane, const Event& event) override;
  void Wait(const Event& event) override;
  void Finish() override;

 private:
  // Marks of an event that were submitted and that were reached.
  struct Marks {
    Lane lane = Lane::kCommands;  // of the last mark
    int64_t submitted = 0, reached = 0;
  };
  class HostEvent;
  class HostRecording;
  using Work = std::function<void()>;

  std::deque<Work>& LaneOf(Lane lane) { return lanes_[size_t(lane)]; }
  void RunNext(Lane lane);
  // Runs `lane`, in which the event was marked, until the mark is reached.
  void RunUntil(Lane lane, const Marks& marks, int64_t mark);
  // CHECKs that the bytes are in one allocation.
  void CheckRange(const void* memory, int64_t bytes) const;
  void RunCommand(const Command& command);
  void CheckGuards() const;

  const Options options_;
  DeviceInfo info_;
  int64_t allocated_ = 0;
  std::map<std::byte*, int64_t> memory_;       // of the device: address, bytes
  std::map<std::byte*, int64_t> host_memory_;  // from AllocateHost
  std::map<const void*, int64_t> registered_;
  std::array<std::deque<Work>, 2> lanes_;
};

}  // namespace shoal::learner::device
