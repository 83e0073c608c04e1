// SPDX-License-Identifier: Apache-2.0
// The device of an NVIDIA GPU: two CUDA streams for the two lanes, recordings as CUDA graphs.
#pragma once

#include <cuda_runtime_api.h>

#include <memory>

#include "learner/device/card/convolutions.h"
#include "learner/device/card/products.h"
#include "learner/device/commands.h"
#include "learner/device/device.h"

namespace shoal::learner::device {

// A stream that is destroyed with its owner.
class CudaStream {
 public:
  CudaStream();
  ~CudaStream();
  CudaStream(const CudaStream&) = delete;
  CudaStream& operator=(const CudaStream&) = delete;

  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

class CudaDevice final : public Device {
 public:
  // Opens the first visible GPU. Throws Error (kDevice).
  explicit CudaDevice(DeviceInfo info);
  ~CudaDevice() override;

  const DeviceInfo& info() const override { return info_; }
  int64_t FreeMemory() const override;

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
  // Memory that commands use in turn, because they run in the order of one stream.
  class Workspace;

  cudaStream_t StreamOf(Lane lane) const;
  // Chooses algorithms and makes the workspace large enough. Nothing may be captured meanwhile.
  void Prepare(const CommandList& commands);
  void Submit(const CommandList& commands);

  const DeviceInfo info_;
  CudaStream commands_, copies_;
  CudaProducts products_;
  CudaConvolutions convolutions_;
  // Recordings keep the workspace with which they were made.
  std::shared_ptr<Workspace> workspace_;
};

}  // namespace shoal::learner::device
