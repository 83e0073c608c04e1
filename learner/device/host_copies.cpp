// SPDX-License-Identifier: Apache-2.0
#include "learner/device/host_copies.h"

#include "learner/device/workspace.h"

namespace shoal::learner::device {

class HostCopies::CopyInMemory final : public Copy {
 public:
  CopyInMemory(Device* device, Memory* memory) : device_(device), memory_(memory) {}
  // The device may still write the memory. A later copy into it is written behind this one.
  ~CopyInMemory() override { memory_->used = false; }
  CopyInMemory(const CopyInMemory&) = delete;
  CopyInMemory& operator=(const CopyInMemory&) = delete;

  const void* Wait() const override {
    device_->Wait(*memory_->arrived);
    return memory_->host;
  }

 private:
  Device* const device_;
  Memory* const memory_;
};

HostCopies::~HostCopies() {
  Quietly([&] { device_->Finish(); });
  for (const Memory& memory : memories_) Quietly([&] { device_->FreeHost(memory.host); });
}

std::shared_ptr<const HostCopies::Copy> HostCopies::Begin(const void* from, int64_t bytes) {
  Memory* const memory = TakeMemory(bytes);
  auto copy = std::make_shared<CopyInMemory>(device_, memory);
  device_->CopyOut(Lane::kCommands, from, bytes, memory->host);
  device_->Mark(Lane::kCommands, memory->arrived.get());
  return copy;
}

// Returns the smallest free memory with enough room.
HostCopies::Memory* HostCopies::TakeMemory(int64_t bytes) {
  Memory* smallest = nullptr;
  for (Memory& memory : memories_) {
    if (memory.used || memory.bytes < bytes) continue;
    if (smallest == nullptr || memory.bytes < smallest->bytes) smallest = &memory;
  }
  if (smallest == nullptr) {
    smallest = &memories_.emplace_back(
        Memory{device_->AllocateHost(bytes), bytes, device_->NewEvent(), false});
  }
  smallest->used = true;
  return smallest;
}

}  // namespace shoal::learner::device
