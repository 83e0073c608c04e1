// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/image_resize.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/base/error.h"

namespace shoal::hosted {
namespace {

constexpr int64_t kMostPixels = 16'000'000;  // 255 * pixels fits 32 bits

SHOAL_CPU_CLONES void AddWeighted(const uint32_t* from, size_t count, uint32_t weight,
                                  uint32_t* sums) {
  for (size_t x = 0; x < count; ++x) sums[x] += weight * from[x];
}

SHOAL_CPU_CLONES void Divide(const uint32_t* sums, size_t count, uint32_t total, uint8_t* to) {
  // A double holds every sum below 2^32 exactly. A quotient that is not an integer is farther from
  // the next integer than the rounding error of the product.
  const double share = 1.0 / total;
  for (size_t x = 0; x < count; ++x) {
    to[x] = uint8_t((double(sums[x]) + 0.5 * total) * share + 1e-10);
  }
}

}  // namespace

ImageResize::ImageResize(const tasks::ImageLayout& layout, bool grey, int height, int width)
    : layout_(layout),
      grey_(grey && layout.channels == 3),
      channels_(grey_ ? 1 : layout.channels),
      height_(height),
      width_(width),
      rows_(Spans(layout.height, height)),
      columns_(Spans(layout.width, width)),
      plane_(size_t(layout.height) * size_t(layout.width)),
      narrowed_(size_t(layout.height) * size_t(width)),
      sums_(size_t(width)) {
  if (int64_t{layout.height} * layout.width > kMostPixels) {
    throw UsageError("environment: an image of {}x{} pixels; expected at most {} pixels",
                     layout.height, layout.width, kMostPixels);
  }
}

// In units of 1 / (from * to) of the side, source pixel k covers [k * to, (k + 1) * to) and output
// pixel i covers [i * from, (i + 1) * from).
std::vector<ImageResize::Span> ImageResize::Spans(int from, int to) {
  std::vector<Span> spans;
  for (int64_t i = 0; i < to; ++i) {
    const int64_t low = i * from, high = low + from;
    Span span{.first = int(low / to), .weights = {}};
    for (int64_t k = span.first; k * to < high; ++k) {
      span.weights.push_back(uint32_t(std::min(high, (k + 1) * to) - std::max(low, k * to)));
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

void ImageResize::TakePlane(const uint8_t* image, int channel) {
  const size_t pixels = plane_.size();
  if (layout_.channels_first) {
    std::copy_n(image + size_t(channel) * pixels, pixels, plane_.begin());
    return;
  }
  const auto step = size_t(layout_.channels);
  for (size_t i = 0; i < pixels; ++i) plane_[i] = image[i * step + size_t(channel)];
}

void ImageResize::TakeGrey(const uint8_t* image) {
  const size_t pixels = plane_.size();
  const size_t step = layout_.channels_first ? 1 : 3, next = layout_.channels_first ? pixels : 1;
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t* pixel = image + i * step;
    const int luma = 77 * pixel[0] + 150 * pixel[next] + 29 * pixel[2 * next];
    plane_[i] = uint8_t((luma + 128) >> 8);
  }
}

void ImageResize::Shrink(std::span<uint8_t> plane) {
  if (layout_.height == height_ && layout_.width == width_) {
    std::ranges::copy(plane_, plane.begin());
    return;
  }
  const auto width = size_t(width_), source = size_t(layout_.width);
  for (size_t y = 0; y < size_t(layout_.height); ++y) {
    const uint8_t* row = plane_.data() + y * source;
    uint32_t* narrowed = narrowed_.data() + y * width;
    for (size_t x = 0; x < width; ++x) {
      const Span& span = columns_[x];
      uint32_t sum = 0;
      for (size_t k = 0; k < span.weights.size(); ++k) {
        sum += span.weights[k] * row[size_t(span.first) + k];
      }
      narrowed[x] = sum;
    }
  }
  const auto total = uint32_t(layout_.height) * uint32_t(layout_.width);
  for (size_t i = 0; i < size_t(height_); ++i) {
    std::ranges::fill(sums_, 0U);
    const Span& span = rows_[i];
    for (size_t k = 0; k < span.weights.size(); ++k) {
      AddWeighted(narrowed_.data() + (size_t(span.first) + k) * width, width, span.weights[k],
                  sums_.data());
    }
    Divide(sums_.data(), width, total, plane.data() + i * width);
  }
}

void ImageResize::Apply(const uint8_t* image, std::span<uint8_t> frame) {
  const size_t plane = size_t(height_) * size_t(width_);
  CHECK(frame.size() == plane * size_t(channels_)) << frame.size();
  for (int c = 0; c < channels_; ++c) {
    if (grey_) {
      TakeGrey(image);
    } else {
      TakePlane(image, c);
    }
    Shrink(frame.subspan(size_t(c) * plane, plane));
  }
}

}  // namespace shoal::hosted
