// SPDX-License-Identifier: Apache-2.0
#include "common/image/frame_stream.h"

#include <cerrno>
#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::image {
namespace {

constexpr char kMagic[9] = "SHOALFS1";
constexpr uint32_t kLargestSide = 4096, kMostChannels = 1024, kMostActions = 1024;

std::unique_ptr<std::FILE, int (*)(std::FILE*)> Open(const std::filesystem::path& path,
                                                     const char* mode, const char* verb) {
  std::FILE* file = std::fopen(path.c_str(), mode);
  if (file == nullptr) {
    throw RuntimeError("cannot {} '{}': {}", verb, path.string(), std::strerror(errno));
  }
  return {file, &std::fclose};
}

bool Plausible(const FrameStreamHeader& header) {
  return header.channels <= kMostChannels && header.height <= kLargestSide &&
         header.width <= kLargestSide && header.view_height <= kLargestSide &&
         header.view_width <= kLargestSide && header.action_size <= kMostActions &&
         header.frame_channels <= header.channels &&
         (header.channels == 0) == (header.frame_channels == 0) &&
         (header.channels == 0 || header.channels % header.frame_channels == 0);
}

}  // namespace

FrameStreamWriter::FrameStreamWriter(const std::filesystem::path& path, FrameStreamHeader header)
    : path_(path), header_(header), file_(Open(path, "wbe", "write")) {
  std::memcpy(header_.magic, kMagic, 8);
  CHECK(Plausible(header_));
  Put(&header_, sizeof header_);
}

void FrameStreamWriter::Write(const FrameRecordHeader& record, std::span<const float> action,
                              std::span<const uint8_t> input, std::span<const uint8_t> view) {
  CHECK(action.size() == header_.action_size) << action.size();
  CHECK(input.size() == header_.InputBytes()) << input.size();
  CHECK(view.size() == header_.ViewBytes()) << view.size();
  Put(&record, sizeof record);
  Put(action.data(), action.size_bytes());
  Put(input.data(), input.size());
  Put(view.data(), view.size());
  // Reports a full disk here, because the result of closing the file is not checked.
  if (std::fflush(file_.get()) != 0) {
    throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(errno));
  }
}

void FrameStreamWriter::Put(const void* bytes, size_t size) {
  if (size == 0 || std::fwrite(bytes, 1, size, file_.get()) == size) return;
  throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(errno));
}

FrameStreamReader::FrameStreamReader(const std::filesystem::path& path)
    : path_(path), file_(Open(path, "rbe", "read")) {
  const size_t read = std::fread(&header_, 1, sizeof header_, file_.get());
  if (read != sizeof header_ || std::memcmp(header_.magic, kMagic, 8) != 0) {
    throw RuntimeError("'{}' is not a stream of frames (expected {})", path_.string(), kMagic);
  }
  if (!Plausible(header_)) {
    throw RuntimeError("'{}': frames of {} x {} x {} and a view of {} x {} are no writer's",
                       path_.string(), header_.channels, header_.height, header_.width,
                       header_.view_height, header_.view_width);
  }
}

std::optional<ShownFrame> FrameStreamReader::Next() {
  ShownFrame frame;
  frame.action.resize(header_.action_size);
  frame.input.resize(header_.InputBytes());
  frame.view.resize(header_.ViewBytes());
  size_t read = std::fread(&frame.record, 1, sizeof frame.record, file_.get());
  if (read == 0 && std::feof(file_.get()) != 0) return std::nullopt;
  const size_t expected =
      sizeof frame.record + 4 * frame.action.size() + frame.input.size() + frame.view.size();
  read += std::fread(frame.action.data(), 1, 4 * frame.action.size(), file_.get());
  read += std::fread(frame.input.data(), 1, frame.input.size(), file_.get());
  read += std::fread(frame.view.data(), 1, frame.view.size(), file_.get());
  if (read != expected) {
    throw RuntimeError("'{}': the last frame has {} of {} bytes", path_.string(), read, expected);
  }
  return frame;
}

}  // namespace shoal::image
