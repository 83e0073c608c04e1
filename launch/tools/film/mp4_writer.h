// SPDX-License-Identifier: Apache-2.0
// Writes pictures as an MP4 file that browsers play: H.264 in yuv420p, its index at the start.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace shoal::launch {

// The file has another name (PATH.tmp-PID) until Finish, and goes away where that is not called.
// Libav's own messages are not shown: its reasons are in the errors. One thread.
class Mp4Writer {
 public:
  // Each picture is shown for `microseconds`. Width and height are even. Makes the file's folder
  // where there is none. Throws Error: a file that cannot be written, an encoder that is missing.
  Mp4Writer(const std::filesystem::path& path, int width, int height, uint32_t microseconds);
  ~Mp4Writer();

  // Rows of 4 bytes per pixel, B G R and one without meaning, `stride` bytes from row to row.
  void Add(std::span<const uint8_t> pixels, int stride);
  uint64_t frames() const;
  // Completes the file and gives it its name. Once, after at least one picture.
  void Finish();

 private:
  struct Encoder;

  std::unique_ptr<Encoder> encoder_;
};

}  // namespace shoal::launch
