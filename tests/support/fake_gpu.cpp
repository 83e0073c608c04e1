// SPDX-License-Identifier: Apache-2.0
// A libshoal-cuda.so whose GPU is the host's memory, for tests of programs that open it. The
// environment variable FAKE_GPU selects its behaviour:
//
//   works            a GPU
//   refuses          no usable GPU: "the fake GPU is taken"
//   another build    a library of another version
//   pins nothing     a GPU that cannot pin the host's memory
//   is lost after N  a GPU that fails after N replays or runs of commands
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "common/base/error.h"
#include "learner/device/card_library.h"
#include "learner/device/host_device.h"

namespace shoal::learner {
namespace {

using device::CommandList;
using device::Device;
using device::DeviceInfo;
using device::Event;
using device::Lane;
using device::Recording;

// Passes everything to a device of the host, until it is lost.
class FakeGpu final : public Device {
 public:
  FakeGpu(int64_t work, bool pins)
      : host_(new device::HostDevice({.registers = pins})), work_left_(work) {}

  const DeviceInfo& info() const override { return info_; }
  int64_t FreeMemory() const override { return Host().FreeMemory(); }
  void* Allocate(int64_t bytes) override { return Host().Allocate(bytes); }
  void Free(void* memory) override { Host().Free(memory); }
  void* AllocateHost(int64_t bytes) override { return Host().AllocateHost(bytes); }
  void FreeHost(void* memory) override { Host().FreeHost(memory); }
  bool RegisterHost(const void* memory, int64_t bytes) override {
    return Host().RegisterHost(memory, bytes);
  }
  void UnregisterHost(const void* memory) override { Host().UnregisterHost(memory); }
  void CopyIn(Lane lane, const void* host, int64_t bytes, void* device) override {
    Host().CopyIn(lane, host, bytes, device);
  }
  void CopyOut(Lane lane, const void* device, int64_t bytes, void* host) override {
    Host().CopyOut(lane, device, bytes, host);
  }
  void Run(const CommandList& commands) override {
    --work_left_;
    Host().Run(commands);
  }
  std::unique_ptr<Recording> Record(const CommandList& commands) override {
    return Host().Record(commands);
  }
  void Replay(const Recording& recording) override {
    --work_left_;
    Host().Replay(recording);
  }
  std::unique_ptr<Event> NewEvent() override { return Host().NewEvent(); }
  void Mark(Lane lane, Event* event) override { Host().Mark(lane, event); }
  void Await(Lane lane, const Event& event) override { Host().Await(lane, event); }
  void Wait(const Event& event) override { Host().Wait(event); }
  void Finish() override { Host().Finish(); }

 private:
  // Once the GPU is lost, every call fails, as with CUDA.
  device::HostDevice& Host() const {
    if (work_left_ < 0) throw DeviceError("GPU: replaying a recording: the fake GPU is lost");
    return *host_;
  }

  // Not destroyed: memory of a lost GPU cannot be freed, which HostDevice would refuse.
  device::HostDevice* const host_;
  const DeviceInfo info_{.name = "Fake GPU",
                         .driver = "1.2.3",
                         .memory_bytes = int64_t{2} << 30,
                         .f32_channels = 1,
                         .bf16_channels = 8};
  int64_t work_left_;
};

template <size_t N>
void Put(const std::string& text, char (&to)[N]) {
  to[text.copy(to, N - 1)] = '\0';
}

int Look(CardUse* use) {
  *use = {.memory_bytes = 1'000'000'000, .memory_size_bytes = 2'000'000'000, .busy = 0.25};
  return 1;
}

}  // namespace
}  // namespace shoal::learner

extern "C" __attribute__((visibility("default"))) void ShoalOpenCard(
    const shoal::learner::ShoalCardRequest* request, shoal::learner::ShoalCardReply* reply) {
  const char* variable = std::getenv("FAKE_GPU");
  const std::string behaviour = variable == nullptr ? "" : variable;
  const std::string lost = "is lost after ";
  shoal::learner::Put(behaviour == "another build" ? "0.0.1 of yesterday" : request->version,
                      reply->version);
  if (behaviour == "refuses") shoal::learner::Put("the fake GPU is taken", reply->refusal);
  shoal::learner::Put("Fake GPU", reply->name);
  shoal::learner::Put("1.2.3", reply->driver);
  reply->memory_bytes = uint64_t{2} << 30;
  if (request->open == 0 || behaviour == "refuses") return;
  reply->look = shoal::learner::Look;
  reply->device = new shoal::learner::FakeGpu(
      behaviour.starts_with(lost) ? std::stoll(behaviour.substr(lost.size())) : INT64_MAX,
      /*pins=*/behaviour != "pins nothing");
}
