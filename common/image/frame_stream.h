// SPDX-License-Identifier: Apache-2.0
// A stream of episodes from one process to another, step by step: the policy's input, the action,
// the reward, and a larger view of the scene. `shoal-actor --evaluate ... --frames FILE` writes
// such a stream to a file or a pipe.
//
//   FrameStreamHeader (40 bytes) | record | record | ...
//   record: FrameRecordHeader (16 bytes) | action (A) f32 | input (K*C, H, W) u8
//           | view (view_height, view_width, 3) u8
//
// Dimensions: A actions; K frames of a stack, C channels of a frame, (H, W) height and width.
//
// The records of an episode are consecutive, the reset first. Row 0 is the top. All numbers are
// little-endian. Readers and writers throw Error naming the file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace shoal::image {

struct FrameStreamHeader {
  char magic[8];                     // "SHOALFS1"
  uint32_t channels, height, width;  // policy's input: K*C, H, W; 0 for a policy without pixels
  uint32_t frame_channels;           // C
  uint32_t view_height, view_width;  // larger view, RGB interleaved; 0 = no view
  uint32_t action_size;              // A
  uint32_t step_microseconds;        // simulated time of an env step; 0 = unknown

  uint64_t InputBytes() const { return uint64_t{channels} * height * width; }
  uint64_t ViewBytes() const { return uint64_t{view_height} * view_width * 3; }
};
static_assert(sizeof(FrameStreamHeader) == 40);

enum FrameRecordFlags : uint32_t {
  kShownSuccess = 1,
  kShownEnd = 2,  // last step of the episode
};

struct FrameRecordHeader {
  uint32_t episode;  // from 0
  uint32_t step;     // 0 = reset, with zeros as action and reward; k = after the k-th step
  float reward;      // reward of the step, unscaled
  uint32_t flags;    // FrameRecordFlags
};
static_assert(sizeof(FrameRecordHeader) == 16);

// Owns the file. Only one thread may use an object.
class FrameStreamWriter {
 public:
  // Sets the magic of `header`. If `path` is a pipe, waits until a reader opens the pipe.
  FrameStreamWriter(const std::filesystem::path& path, FrameStreamHeader header);

  // Writes and flushes a record. CHECKs that the sizes match the header.
  void Write(const FrameRecordHeader& record, std::span<const float> action,
             std::span<const uint8_t> input, std::span<const uint8_t> view);

 private:
  void Put(const void* bytes, size_t size);

  const std::filesystem::path path_;
  FrameStreamHeader header_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

struct ShownFrame {
  FrameRecordHeader record{};
  std::vector<float> action;
  std::vector<uint8_t> input, view;
};

// Owns the file. Only one thread may use an object.
class FrameStreamReader {
 public:
  // Throws Error if the file is not a stream of this version or its header has invalid sizes.
  explicit FrameStreamReader(const std::filesystem::path& path);

  const FrameStreamHeader& header() const { return header_; }
  // The next record; empty at the end of the stream. Throws Error if a record is incomplete.
  std::optional<ShownFrame> Next();

 private:
  const std::filesystem::path path_;
  FrameStreamHeader header_{};
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace shoal::image
