// SPDX-License-Identifier: Apache-2.0
// Grey pictures for bandits: a bright bar on a dark background.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace shoal::learner {

inline constexpr int kBarWidth = 3;  // pixels

// Fills a picture of side x side with a bar whose left edge is column x. Returns the bar's
// position: -1 at the left side of the picture, 1 at the right side.
inline float DrawBar(int x, int side, std::span<uint8_t> picture) {
  for (int i = 0; i < side * side; ++i) {
    const int column = i % side;
    picture[size_t(i)] = column >= x && column < x + kBarWidth ? 230 : 20;
  }
  return 2 * float(x) / float(side - kBarWidth) - 1;
}

}  // namespace shoal::learner
