// SPDX-License-Identifier: Apache-2.0
// The last K frames of one environment, oldest first, in the layout of the network's input:
// (K*C, H, W) uint8. At the start of an episode, the first frame is repeated.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace shoal {

// Writes to memory of K * frame_bytes bytes that the caller owns: one slice of the inference batch.
class FrameStack {
 public:
  FrameStack(std::span<uint8_t> stack, int frame_bytes)
      : stack_(stack), frame_bytes_(static_cast<size_t>(frame_bytes)) {}

  // Begins an episode: fills the stack with its first frame.
  void Reset(std::span<const uint8_t> frame) {
    for (size_t at = 0; at < stack_.size(); at += frame_bytes_) Put(at, frame);
  }

  // Removes the oldest frame and appends `frame`.
  void Push(std::span<const uint8_t> frame) {
    if (stack_.empty()) return;
    std::memmove(stack_.data(), stack_.data() + frame_bytes_, stack_.size() - frame_bytes_);
    Put(stack_.size() - frame_bytes_, frame);
  }

 private:
  void Put(size_t at, std::span<const uint8_t> frame) {
    std::memcpy(stack_.data() + at, frame.data(), frame_bytes_);
  }

  std::span<uint8_t> stack_;
  size_t frame_bytes_;
};

}  // namespace shoal
