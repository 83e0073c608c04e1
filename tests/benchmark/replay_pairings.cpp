// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <memory>

#include "common/base/random.h"
#include "replay_server/core/random_shift.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kPlanes = 6, kSize = 84, kImages = 64, kBorder = 4;
constexpr int kImageBytes = kPlanes * kSize * kSize;

struct Images {
  std::vector<uint8_t> in = std::vector<uint8_t>(size_t{kImages} * kImageBytes);
  std::vector<uint8_t> out = std::vector<uint8_t>(in.size());
  std::vector<uint8_t> padded =
      std::vector<uint8_t>(size_t{kPlanes} * (kSize + 2 * kBorder) * (kSize + 2 * kBorder));
  Random random{1};

  Images() {
    std::generate(in.begin(), in.end(), [this] { return uint8_t(random.Next()); });
  }
};

// The published implementation: pad, then crop.
void PadAndCrop(const uint8_t* in, replay::Shift shift, std::vector<uint8_t>& padded,
                uint8_t* out) {
  constexpr int kWide = kSize + 2 * kBorder;
  for (int p = 0; p < kPlanes; ++p) {
    for (int i = 0; i < kWide; ++i) {
      for (int j = 0; j < kWide; ++j) {
        const int y = std::clamp(i - kBorder, 0, kSize - 1),
                  x = std::clamp(j - kBorder, 0, kSize - 1);
        padded[size_t(p * kWide + i) * kWide + j] = in[(p * kSize + y) * kSize + x];
      }
    }
    for (int i = 0; i < kSize; ++i) {
      std::memcpy(
          out + (p * kSize + i) * kSize,
          &padded[size_t(p * kWide + i + kBorder + shift.dy) * kWide + (kBorder + shift.dx)],
          kSize);
    }
  }
}

}  // namespace

std::vector<Pairing> ReplayPairings() {
  const auto images = std::make_shared<Images>();
  const auto for_each = [images](auto act) {
    return [images, act] {
      for (int n = 0; n < kImages; ++n) {
        const size_t at = size_t(n) * kImageBytes;
        act(&images->in[at], replay::DrawShift(kBorder, &images->random), &images->out[at]);
      }
    };
  };
  const auto fused = for_each([](const uint8_t* in, replay::Shift shift, uint8_t* out) {
    replay::ShiftPlanes(in, kPlanes, kSize, kSize, shift, out);
  });
  return {{.stage = "random shift of a (6, 84, 84) image",
           .unit = "images/s",
           .against = "pad, then crop",
           .units_per_call = kImages,
           .target = 2,
           .ours = fused,
           .other = for_each([images](const uint8_t* in, replay::Shift shift, uint8_t* out) {
             PadAndCrop(in, shift, images->padded, out);
           })},
          {.stage = "random shift of a (6, 84, 84) image",
           .unit = "images/s",
           .against = "memcpy of it",
           .units_per_call = kImages,
           .ours = fused,
           .other = for_each([](const uint8_t* in, replay::Shift, uint8_t* out) {
             std::memcpy(out, in, kImageBytes);
           })}};
}

}  // namespace shoal::bench
