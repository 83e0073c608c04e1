// SPDX-License-Identifier: Apache-2.0
// Some pictures of an episode side by side, for places that show images but no videos.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shoal::launch {

// A borrowed picture: rows of 4 bytes per pixel (B, G, R and an unused byte), `stride` bytes from
// one row to the next.
struct PictureView {
  int width = 0, height = 0, stride = 0;
  std::span<const uint8_t> pixels;
};

struct StripImage {
  int width = 0, height = 0;
  std::string png;  // RGB
};

// Takes an episode's pictures in order and keeps a bounded number of evenly spread pictures. One
// thread.
class FilmStrip {
 public:
  static constexpr size_t kPictures = 6;
  static constexpr int kShrink = 2;  // the strip has every second row and column

  // All pictures of one strip must have the same size.
  void Add(const PictureView& picture);
  // At most kPictures of the added pictures from left to right, including the first and the last.
  // At least one picture must have been added.
  StripImage Image() const;

 private:
  std::vector<uint8_t> Shrunk(const PictureView& picture) const;  // (height_, width_, 3) RGB

  int width_ = 0, height_ = 0;
  size_t seen_ = 0, stride_ = 1;
  std::vector<std::vector<uint8_t>> kept_;
  std::vector<uint8_t> newest_;
};

}  // namespace shoal::launch
