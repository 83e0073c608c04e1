// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/hosted_view.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::actor {

void HostedView::Begin(uint64_t, std::span<uint8_t> picture) { Draw(picture); }

void HostedView::Step(std::span<const float>, float, std::span<uint8_t> picture) { Draw(picture); }

void HostedView::MakeFit(const hosted::RawPicture& drawn) {
  const double scale = std::min(double(height_) / drawn.height, double(width_) / drawn.width);
  const int height = std::clamp(int(std::lround(scale * drawn.height)), 1, height_);
  const int width = std::clamp(int(std::lround(scale * drawn.width)), 1, width_);
  fit_.emplace(
      Fit{.from_height = drawn.height,
          .from_width = drawn.width,
          .height = height,
          .width = width,
          .resize = hosted::ImageResize(
              {.height = drawn.height, .width = drawn.width, .channels = 3}, false, height, width),
          .planes = std::vector<uint8_t>(size_t{3} * size_t(height) * size_t(width))});
}

void HostedView::Draw(std::span<uint8_t> picture) {
  CHECK(picture.size() == size_t{3} * size_t(height_) * size_t(width_)) << picture.size();
  const hosted::RawPicture drawn = environment_.Render();
  if (!fit_) MakeFit(drawn);
  Fit& fit = *fit_;
  if (drawn.height != fit.from_height || drawn.width != fit.from_width) {
    throw RuntimeError("render drew a picture of {}x{} pixels after one of {}x{}", drawn.width,
                       drawn.height, fit.from_width, fit.from_height);
  }
  fit.resize.Apply(drawn.pixels.data(), fit.planes);
  std::ranges::fill(picture, uint8_t{0});
  const size_t plane = size_t(fit.height) * size_t(fit.width);
  const size_t top = size_t(height_ - fit.height) / 2, left = size_t(width_ - fit.width) / 2;
  for (size_t y = 0; y < size_t(fit.height); ++y) {
    for (size_t x = 0; x < size_t(fit.width); ++x) {
      uint8_t* pixel = picture.data() + 3 * ((top + y) * size_t(width_) + left + x);
      for (size_t c = 0; c < 3; ++c) {
        pixel[c] = fit.planes[c * plane + y * size_t(fit.width) + x];
      }
    }
  }
}

}  // namespace shoal::actor
