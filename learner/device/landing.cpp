// SPDX-License-Identifier: Apache-2.0
#include "learner/device/landing.h"

#include <algorithm>

#include "learner/device/workspace.h"

namespace shoal::learner::device {
namespace {

constexpr int64_t kLandingChunk = 1 << 20;  // bytes
constexpr int64_t kLandingAlignment = 256;  // bytes

}  // namespace

Landing::Landing(Device* device)
    : device_(device), arrived_(device->NewEvent()), used_(device->NewEvent()) {}

Landing::~Landing() {
  for (const Chunk& chunk : chunks_) {
    Quietly([&] { device_->FreeHost(chunk.host); });
    Quietly([&] { device_->Free(chunk.device); });
  }
  for (const Borrowed& borrowed : borrowed_) Quietly([&] { device_->Free(borrowed.device); });
}

void Landing::Begin() {
  device_->Wait(*arrived_);
  // The device's memory may still be read by the update that used this landing before.
  device_->Await(Lane::kCopies, *used_);
  for (Chunk& chunk : chunks_) chunk.used = 0;
  chunk_ = next_borrowed_ = 0;
}

Landing::Place Landing::NewPlace(int64_t bytes) {
  const int64_t padded = (bytes + kLandingAlignment - 1) / kLandingAlignment * kLandingAlignment;
  while (chunk_ < chunks_.size() && chunks_[chunk_].used + padded > chunks_[chunk_].bytes) ++chunk_;
  if (chunk_ == chunks_.size()) {
    const int64_t size = std::max(kLandingChunk, padded);
    chunks_.push_back({static_cast<uint8_t*>(device_->AllocateHost(size)),
                       static_cast<uint8_t*>(device_->Allocate(size)), size, 0});
  }
  Chunk& chunk = chunks_[chunk_];
  const Place place{chunk.host + chunk.used, chunk.device + chunk.used};
  chunk.used += padded;
  return place;
}

uint8_t* Landing::Borrow(std::span<const uint8_t> bytes) {
  const auto size = int64_t(bytes.size());
  if (next_borrowed_ == borrowed_.size()) borrowed_.push_back({nullptr, 0});
  Borrowed& borrowed = borrowed_[next_borrowed_++];
  if (borrowed.bytes < size) {
    if (borrowed.device != nullptr) device_->Free(borrowed.device);
    borrowed = {static_cast<uint8_t*>(device_->Allocate(size)), size};
  }
  device_->CopyIn(Lane::kCopies, bytes.data(), size, borrowed.device);
  return borrowed.device;
}

void Landing::Send() {
  for (const Chunk& chunk : chunks_) {
    if (chunk.used > 0) device_->CopyIn(Lane::kCopies, chunk.host, chunk.used, chunk.device);
  }
  device_->Mark(Lane::kCopies, arrived_.get());
  device_->Await(Lane::kCommands, *arrived_);
}

}  // namespace shoal::learner::device
