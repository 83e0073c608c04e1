// SPDX-License-Identifier: Apache-2.0
// Writes pictures as an MP4 file that browsers play: H.264 in yuv420p, with the index at the start.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace shoal::launch {

// The file has a temporary name (PATH.tmp-PID) until Finish; without Finish the destructor removes
// the file. Messages of libav are not printed; errors contain its reasons. One thread.
class Mp4Writer {
 public:
  // Each picture is shown for `microseconds`. Width and height must be even. Creates the folder of
  // the file if necessary. Throws Error if the file cannot be written or an encoder is missing.
  Mp4Writer(const std::filesystem::path& path, int width, int height, uint32_t microseconds);
  ~Mp4Writer();

  // Adds a picture: rows of 4 bytes per pixel (B, G, R and an unused byte), `stride` bytes from one
  // row to the next.
  void Add(std::span<const uint8_t> pixels, int stride);
  uint64_t frames() const;
  // Completes the file and renames it to its final name. Call once, after at least one picture.
  void Finish();

 private:
  struct Encoder;

  std::unique_ptr<Encoder> encoder_;
};

}  // namespace shoal::launch
