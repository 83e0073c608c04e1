// SPDX-License-Identifier: Apache-2.0
#include "learner/device/workspace.h"

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

constexpr int64_t kChunk = 1 << 20;       // bytes of a chunk that several arrays share
constexpr int64_t kArrayAlignment = 256;  // bytes

int64_t RoundUp(int64_t n, int64_t unit) { return (n + unit - 1) / unit * unit; }

}  // namespace

Workspace::Workspace(Device* device, nn::Precision precision, int batch)
    : device_(device),
      batch_(batch),
      compute_type_(precision == nn::Precision::kBf16 ? Type::kBf16 : Type::kF32),
      host_copies_(std::make_unique<HostCopies>(device)) {
  CHECK(batch > 0) << batch;
}

Workspace::~Workspace() {
  for (void* chunk : chunks_) Quietly([&] { device_->Free(chunk); });
}

int Workspace::PaddedChannels(int channels) const {
  const DeviceInfo& info = device_->info();
  const int unit = compute_type_ == Type::kBf16 ? info.bf16_channels : info.f32_channels;
  return int(RoundUp(channels, unit));
}

void* Workspace::NewChunk(int64_t bytes) {
  chunks_.push_back(device_->Allocate(bytes));
  CommandList clear;
  clear.Add(Clear{.memory = chunks_.back(), .bytes = bytes});
  device_->Run(clear);
  return chunks_.back();
}

void* Workspace::NewBytes(int64_t bytes) {
  if (bytes == 0) return nullptr;
  bytes = RoundUp(bytes, kArrayAlignment);
  if (bytes > kChunk / 4) return NewChunk(bytes);
  if (bytes > free_bytes_) {
    free_ = static_cast<uint8_t*>(NewChunk(kChunk));
    free_bytes_ = kChunk;
  }
  void* memory = free_;
  free_ += bytes;
  free_bytes_ -= bytes;
  return memory;
}

void Workspace::Add(const Command& command) {
  if (listing_) return list_.Add(command);
  CommandList alone;
  alone.Add(command);
  device_->Run(alone);
}

void Workspace::BeginList(const Command& first) {
  CHECK(!listing_);
  listing_ = true;
  list_.Reset();
  list_.Add(first);
}

const CommandList& Workspace::EndList(const Command& first) {
  CHECK(listing_);
  listing_ = false;
  list_.Replace(0, first);
  return list_;
}

}  // namespace shoal::learner::device
