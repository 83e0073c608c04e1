// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film_strip.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/image/png.h"

namespace shoal::launch {
namespace {

constexpr int kRgb = 3, kBgrx = 4;

}  // namespace

std::vector<uint8_t> FilmStrip::Shrunk(const PictureView& picture) const {
  std::vector<uint8_t> rgb;
  rgb.reserve(static_cast<size_t>(width_) * static_cast<size_t>(height_) * kRgb);
  for (int y = 0; y < height_; ++y) {
    const uint8_t* row = &picture.pixels[static_cast<size_t>(y * kShrink * picture.stride)];
    for (int x = 0; x < width_; ++x) {
      const uint8_t* pixel = row + x * kShrink * kBgrx;
      rgb.insert(rgb.end(), {pixel[2], pixel[1], pixel[0]});
    }
  }
  return rgb;
}

void FilmStrip::Add(const PictureView& picture) {
  if (seen_ == 0) {
    width_ = picture.width / kShrink;
    height_ = picture.height / kShrink;
  }
  CHECK(picture.width / kShrink == width_ && picture.height / kShrink == height_)
      << picture.width << " x " << picture.height;
  newest_ = Shrunk(picture);
  if (seen_++ % stride_ != 0) return;
  kept_.push_back(newest_);
  if (kept_.size() < 2 * kPictures) return;
  // Keep every second picture from now on, so that memory does not grow with the episode.
  for (size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i].swap(kept_[2 * i]);
  kept_.resize((kept_.size() + 1) / 2);
  stride_ *= 2;
}

StripImage FilmStrip::Image() const {
  CHECK(!kept_.empty());
  std::vector<const std::vector<uint8_t>*> chosen;
  for (const auto& picture : kept_) chosen.push_back(&picture);
  if ((seen_ - 1) % stride_ != 0) chosen.push_back(&newest_);
  const size_t count = std::min(chosen.size(), kPictures);
  const size_t row = static_cast<size_t>(width_) * kRgb;
  std::vector<uint8_t> pixels;
  pixels.reserve(count * row * static_cast<size_t>(height_));
  for (size_t y = 0; y < static_cast<size_t>(height_); ++y) {
    for (size_t i = 0; i < count; ++i) {
      const size_t at = count == 1 ? 0 : i * (chosen.size() - 1) / (count - 1);
      const auto from = chosen[at]->begin() + static_cast<std::ptrdiff_t>(y * row);
      pixels.insert(pixels.end(), from, from + static_cast<std::ptrdiff_t>(row));
    }
  }
  const int width = width_ * static_cast<int>(count);
  return {width, height_, image::EncodePng(width, height_, kRgb, pixels)};
}

}  // namespace shoal::launch
