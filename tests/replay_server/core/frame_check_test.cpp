// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/frame_check.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "common/base/random.h"

namespace shoal::replay {
namespace {

std::vector<uint8_t> Noise(size_t bytes) {
  Random random(bytes + 1);
  std::vector<uint8_t> noise(bytes);
  for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random.Next());
  return noise;
}

TEST(FrameCheck, EveryFlippedBitChangesIt) {
  for (const size_t bytes : {1u, 7u, 8u, 31u, 32u, 33u, 100u, 420u}) {
    std::vector<uint8_t> frame = Noise(bytes);
    std::set<uint64_t> checks{FrameCheck(frame)};
    for (size_t bit = 0; bit < 8 * bytes; ++bit) {
      frame[bit / 8] = static_cast<uint8_t>(frame[bit / 8] ^ (1 << bit % 8));
      EXPECT_TRUE(checks.insert(FrameCheck(frame)).second) << "bit " << bit << " of " << bytes;
      frame[bit / 8] = static_cast<uint8_t>(frame[bit / 8] ^ (1 << bit % 8));
    }
  }
}

TEST(FrameCheck, LengthOrderAndZerosCount) {
  const std::vector<uint8_t> zeros(64);
  std::set<uint64_t> checks;
  for (size_t bytes = 0; bytes <= 64; ++bytes) checks.insert(FrameCheck({zeros.data(), bytes}));
  EXPECT_EQ(checks.size(), 65u);
  std::vector<uint8_t> frame = Noise(64);
  const uint64_t before = FrameCheck(frame);
  std::swap_ranges(frame.begin(), frame.begin() + 32, frame.begin() + 32);
  EXPECT_NE(FrameCheck(frame), before);
}

// Files contain the word: an accidental change of the function would refuse them all.
TEST(FrameCheck, KeepsItsValues) {
  EXPECT_EQ(FrameCheck({}), 625047191052667199u);
  EXPECT_EQ(FrameCheck(Noise(33)), 1736442720695497170u);
}

}  // namespace
}  // namespace shoal::replay
