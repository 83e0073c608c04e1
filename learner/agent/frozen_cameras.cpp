// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/frozen_cameras.h"

#include <algorithm>
#include <cstring>

namespace shoal::learner {
namespace {

// Planes of one camera, (P, H, W).
struct View {
  const uint8_t* pixels;
  int planes, height, width;

  const uint8_t* Row(int plane, int y, int x) const {
    return pixels + (int64_t{plane} * height + y) * width + x;
  }
};

// Whether `a`, without a border of `margin`, equals `b` at the offset.
bool EqualAt(const View& a, const View& b, int margin, int dy, int dx) {
  const auto bytes = static_cast<size_t>(a.width - 2 * margin);
  for (int plane = 0; plane < a.planes; ++plane) {
    for (int y = margin; y < a.height - margin; ++y) {
      if (std::memcmp(a.Row(plane, y, margin), b.Row(plane, y + dy, margin + dx), bytes) != 0) {
        return false;
      }
    }
  }
  return true;
}

bool SamePicture(const View& a, const View& b, int margin) {
  for (int dy = -margin; dy <= margin; ++dy) {
    for (int dx = -margin; dx <= margin; ++dx) {
      if (EqualAt(a, b, margin, dy, dx)) return true;
    }
  }
  return false;
}

}  // namespace

int FrozenCameras(std::span<const uint8_t> stacks, const ObservationSpec& spec, int shift_pad) {
  const int margin = 2 * shift_pad;
  if (!spec.HasPixels() || 2 * margin >= std::min(spec.height, spec.width)) return 0;
  const int64_t frame = spec.FrameBytes(), input = spec.InputBytes();
  const int64_t count =
      std::min<int64_t>(static_cast<int64_t>(stacks.size()) / input, kComparedStacks);
  if (count < 2) return 0;
  const int cameras = static_cast<int>(spec.cameras.size());
  const int planes = spec.channels / cameras;
  int frozen = 0;
  for (int camera = 0; camera < cameras; ++camera) {
    const auto view = [&](int64_t i) {
      const uint8_t* newest = stacks.data() + i * input + (spec.stack - 1) * frame;
      return View{newest + int64_t{camera} * planes * spec.height * spec.width, planes, spec.height,
                  spec.width};
    };
    int64_t same = 1;
    while (same < count && SamePicture(view(0), view(same), margin)) ++same;
    if (same == count) ++frozen;
  }
  return frozen;
}

}  // namespace shoal::learner
