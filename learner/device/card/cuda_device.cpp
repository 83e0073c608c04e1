// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/cuda_device.h"

#include <algorithm>
#include <utility>

#include "learner/device/card/cuda_error.h"
#include "learner/device/card/launches.h"

namespace shoal::learner::device {
namespace {

// The host sleeps while it waits: actors use its cores.
class CudaEvent final : public Event {
 public:
  CudaEvent() {
    Require(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming | cudaEventBlockingSync),
            "making an event");
  }
  ~CudaEvent() override { cudaEventDestroy(event_); }
  CudaEvent(const CudaEvent&) = delete;
  CudaEvent& operator=(const CudaEvent&) = delete;

  cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

cudaEvent_t EventOf(const Event& event) { return static_cast<const CudaEvent&>(event).get(); }

}  // namespace

class CudaDevice::Workspace {
 public:
  explicit Workspace(int64_t size) : bytes(size) {
    Require(cudaMalloc(&memory_, static_cast<size_t>(size)), "allocating a workspace");
  }
  ~Workspace() { cudaFree(memory_); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void* get() const { return memory_; }
  const int64_t bytes;

 private:
  void* memory_ = nullptr;
};

namespace {

class CudaRecording final : public Recording {
 public:
  // Instantiates the graph. Keeps the workspace that the graph's commands use.
  CudaRecording(cudaGraph_t graph, std::shared_ptr<void> workspace)
      : workspace_(std::move(workspace)) {
    Require(cudaGraphInstantiate(&graph_, graph, 0), "preparing a recording");
  }
  ~CudaRecording() override { cudaGraphExecDestroy(graph_); }
  CudaRecording(const CudaRecording&) = delete;
  CudaRecording& operator=(const CudaRecording&) = delete;

  cudaGraphExec_t get() const { return graph_; }

 private:
  const std::shared_ptr<void> workspace_;
  cudaGraphExec_t graph_ = nullptr;
};

// Captures the work of a stream instead of running it.
class Capture {
 public:
  explicit Capture(cudaStream_t stream) : stream_(stream) {
    // Relaxed: the first launch of a kernel loads the kernel's code.
    Require(cudaStreamBeginCapture(stream, cudaStreamCaptureModeRelaxed), "beginning a recording");
  }
  // Ends a capture that an error has interrupted.
  ~Capture() {
    if (!ended_) {
      cudaStreamEndCapture(stream_, &graph_);
      cudaGetLastError();
    }
    if (graph_ != nullptr) cudaGraphDestroy(graph_);
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // The graph, which this object owns.
  cudaGraph_t End() {
    ended_ = true;
    Require(cudaStreamEndCapture(stream_, &graph_), "ending a recording");
    return graph_;
  }

 private:
  const cudaStream_t stream_;
  cudaGraph_t graph_ = nullptr;
  bool ended_ = false;
};

}  // namespace

CudaStream::CudaStream() {
  Require(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "opening the GPU");
}

CudaStream::~CudaStream() { cudaStreamDestroy(stream_); }

CudaDevice::CudaDevice(DeviceInfo info) : info_(std::move(info)), convolutions_(commands_.get()) {}

CudaDevice::~CudaDevice() {
  // Errors of a lost GPU have no effect here.
  cudaStreamSynchronize(copies_.get());
  cudaStreamSynchronize(commands_.get());
}

cudaStream_t CudaDevice::StreamOf(Lane lane) const {
  return lane == Lane::kCommands ? commands_.get() : copies_.get();
}

int64_t CudaDevice::FreeMemory() const {
  size_t free = 0, total = 0;
  Require(cudaMemGetInfo(&free, &total), "reading the free memory");
  return static_cast<int64_t>(free);
}

void* CudaDevice::Allocate(int64_t bytes) {
  void* memory = nullptr;
  const cudaError_t status = cudaMalloc(&memory, static_cast<size_t>(bytes));
  if (status == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    throw DeviceError("GPU {}: no room for {} MB more, {} of {} MB are free", info_.name,
                      (bytes >> 20) + 1, FreeMemory() >> 20, info_.memory_bytes >> 20);
  }
  Require(status, "allocating memory");
  return memory;
}

void CudaDevice::Free(void* memory) {
  if (memory == nullptr) return;
  Finish();
  Require(cudaFree(memory), "freeing memory");
}

void* CudaDevice::AllocateHost(int64_t bytes) {
  void* memory = nullptr;
  Require(cudaHostAlloc(&memory, static_cast<size_t>(bytes), cudaHostAllocDefault),
          "allocating pinned host memory");
  return memory;
}

void CudaDevice::FreeHost(void* memory) {
  if (memory != nullptr) Require(cudaFreeHost(memory), "freeing pinned host memory");
}

bool CudaDevice::RegisterHost(const void* memory, int64_t bytes) {
  const cudaError_t status = cudaHostRegister(const_cast<void*>(memory), static_cast<size_t>(bytes),
                                              cudaHostRegisterDefault);
  cudaGetLastError();
  return status == cudaSuccess;
}

void CudaDevice::UnregisterHost(const void* memory) {
  Require(cudaHostUnregister(const_cast<void*>(memory)), "releasing host memory");
}

void CudaDevice::CopyIn(Lane lane, const void* host, int64_t bytes, void* device) {
  Require(cudaMemcpyAsync(device, host, static_cast<size_t>(bytes), cudaMemcpyHostToDevice,
                          StreamOf(lane)),
          "copying to the GPU");
}

void CudaDevice::CopyOut(Lane lane, const void* device, int64_t bytes, void* host) {
  Require(cudaMemcpyAsync(host, device, static_cast<size_t>(bytes), cudaMemcpyDeviceToHost,
                          StreamOf(lane)),
          "copying from the GPU");
}

void CudaDevice::Prepare(const CommandList& commands) {
  int64_t bytes = 0;
  for (const Command& command : commands.commands()) {
    int64_t needed = 0;
    if (const auto* product = std::get_if<Product>(&command)) {
      products_.Prepare(*product);
      needed = CudaProducts::kWorkspaceBytes;
    } else if (const auto* forward = std::get_if<ConvolutionForward>(&command)) {
      needed = convolutions_.Prepare(*forward);
    } else if (const auto* data = std::get_if<ConvolutionData>(&command)) {
      needed = convolutions_.Prepare(*data);
    } else if (const auto* weights = std::get_if<ConvolutionWeights>(&command)) {
      needed = convolutions_.Prepare(*weights);
    }
    bytes = std::max(bytes, needed);
  }
  if (bytes == 0 || (workspace_ != nullptr && workspace_->bytes >= bytes)) return;
  Finish();  // the smaller workspace may be in use, and may be freed now
  workspace_ = std::make_shared<Workspace>(bytes);
}

void CudaDevice::Submit(const CommandList& commands) {
  const cudaStream_t stream = commands_.get();
  void* const workspace = workspace_ == nullptr ? nullptr : workspace_->get();
  for (const Command& command : commands.commands()) {
    if (const auto* kernel = std::get_if<kernels::Kernel>(&command)) {
      Launch(*kernel, stream);
    } else if (const auto* clear = std::get_if<Clear>(&command)) {
      Require(cudaMemsetAsync(clear->memory, 0, static_cast<size_t>(clear->bytes), stream),
              "clearing memory");
    } else if (const auto* copy = std::get_if<Copy>(&command)) {
      Require(cudaMemcpyAsync(copy->to, copy->from, static_cast<size_t>(copy->bytes),
                              cudaMemcpyDeviceToDevice, stream),
              "copying on the GPU");
    } else if (const auto* product = std::get_if<Product>(&command)) {
      products_.Run(*product, workspace, stream);
    } else if (const auto* forward = std::get_if<ConvolutionForward>(&command)) {
      convolutions_.Run(*forward, workspace);
    } else if (const auto* data = std::get_if<ConvolutionData>(&command)) {
      convolutions_.Run(*data, workspace);
    } else {
      convolutions_.Run(std::get<ConvolutionWeights>(command), workspace);
    }
  }
}

void CudaDevice::Run(const CommandList& commands) {
  Prepare(commands);
  Submit(commands);
}

std::unique_ptr<Recording> CudaDevice::Record(const CommandList& commands) {
  Prepare(commands);
  Capture capture(commands_.get());
  Submit(commands);
  return std::make_unique<CudaRecording>(capture.End(), workspace_);
}

void CudaDevice::Replay(const Recording& recording) {
  Require(cudaGraphLaunch(static_cast<const CudaRecording&>(recording).get(), commands_.get()),
          "replaying a recording");
}

std::unique_ptr<Event> CudaDevice::NewEvent() { return std::make_unique<CudaEvent>(); }

void CudaDevice::Mark(Lane lane, Event* event) {
  Require(cudaEventRecord(EventOf(*event), StreamOf(lane)), "marking an event");
}

void CudaDevice::Await(Lane lane, const Event& event) {
  Require(cudaStreamWaitEvent(StreamOf(lane), EventOf(event), 0), "awaiting an event");
}

void CudaDevice::Wait(const Event& event) {
  Require(cudaEventSynchronize(EventOf(event)), "waiting for the GPU");
}

void CudaDevice::Finish() {
  Require(cudaStreamSynchronize(copies_.get()), "waiting for the GPU");
  Require(cudaStreamSynchronize(commands_.get()), "waiting for the GPU");
}

}  // namespace shoal::learner::device
