// SPDX-License-Identifier: Apache-2.0
// Interface of a device: a processor with memory of its own, which runs lists of commands
// (commands.h). DeviceEngine computes with a device and knows no more of it than this interface.
//
// A device has two lanes. Work of one lane runs in the order in which it was submitted; work of
// different lanes runs in any order, unless events order it. All functions except those that say
// otherwise only submit work and return.
//
// Addresses: memory of the device is named by plain pointers, which only the device may
// dereference. Threads: one at a time. Errors: every function but destructors throws Error
// (kDevice) with one line that names the device and the cause if the device lacks memory, was lost
// or refuses a command. An error of submitted work is thrown by a later call.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace shoal::learner::device {

class CommandList;  // commands.h

// The lane of commands, and the lane of copies that run beside commands.
enum class Lane { kCommands, kCopies };

// A point in the work of a lane. Owned by the caller; must be destroyed before its device.
class Event {
 public:
  virtual ~Event() = default;
};

// A list of commands that a device has prepared, so that submitting it costs little. Owned by the
// caller; must be destroyed before its device, and not while its work is running.
class Recording {
 public:
  virtual ~Recording() = default;
};

struct DeviceInfo {
  std::string name;          // for example "NVIDIA H100 80GB HBM3"
  std::string driver;        // version; empty for the host
  int64_t memory_bytes = 0;  // total
  // Channels of maps and of convolutions' weights must be multiples of this number, by type.
  int f32_channels = 1, bf16_channels = 1;
};

class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const = 0;
  virtual int64_t FreeMemory() const = 0;  // bytes

  // ---- Memory ----

  // Returns `bytes` bytes of undefined contents, aligned to 256 bytes. Free waits for all work.
  virtual void* Allocate(int64_t bytes) = 0;
  virtual void Free(void* memory) = 0;
  // Returns host memory from and to which copies are asynchronous. Must be freed before the device
  // is destroyed.
  virtual void* AllocateHost(int64_t bytes) = 0;
  virtual void FreeHost(void* memory) = 0;
  // Prepares host memory of the caller for asynchronous copies, until Unregister. Returns false if
  // the device cannot do this; copies are then correct, but wait for the lane.
  virtual bool RegisterHost(const void* memory, int64_t bytes) = 0;
  virtual void UnregisterHost(const void* memory) = 0;

  // ---- Copies ----

  // Host memory must stay unchanged until the copy has been done (Mark, then Wait or Finish).
  virtual void CopyIn(Lane lane, const void* host, int64_t bytes, void* device) = 0;
  virtual void CopyOut(Lane lane, const void* device, int64_t bytes, void* host) = 0;

  // ---- Commands, all on Lane::kCommands ----

  // Runs the commands in their order. The list may be destroyed afterwards.
  virtual void Run(const CommandList& commands) = 0;
  // Prepares the commands without running them.
  virtual std::unique_ptr<Recording> Record(const CommandList& commands) = 0;
  // Runs the commands of a recording of this device.
  virtual void Replay(const Recording& recording) = 0;

  // ---- Order ----

  virtual std::unique_ptr<Event> NewEvent() = 0;
  // Sets the event to the end of the work that `lane` has so far. An event may be set again.
  virtual void Mark(Lane lane, Event* event) = 0;
  // Lets later work of `lane` wait for the event. An event that was never set is reached.
  virtual void Await(Lane lane, const Event& event) = 0;
  // The host waits for the event.
  virtual void Wait(const Event& event) = 0;
  // Waits for all work of both lanes.
  virtual void Finish() = 0;
};

}  // namespace shoal::learner::device
