// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/frame_check.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/base/random.h"

namespace shoal::replay {
namespace {

constexpr uint64_t kOfWord = 0x9fb21c651e98df25ULL, kOfLane = 0xd6e8feb86659fd93ULL;  // odd

uint64_t Step(uint64_t lane, uint64_t word) {
  return std::rotl(lane + word * kOfWord, 31) * kOfLane;
}

}  // namespace

uint64_t FrameCheck(std::span<const uint8_t> frame) {
  uint64_t lanes[4] = {1, 2, 3, 4};
  size_t at = 0;
  for (; at + 32 <= frame.size(); at += 32) {
    uint64_t words[4];
    std::memcpy(words, frame.data() + at, sizeof words);
    for (int j = 0; j < 4; ++j) lanes[j] = Step(lanes[j], words[j]);
  }
  for (int j = 0; at < frame.size(); ++j, at += 8) {
    uint64_t word = 0;
    std::memcpy(&word, frame.data() + at, std::min<size_t>(8, frame.size() - at));
    lanes[j] = Step(lanes[j], word);
  }
  return HashWords({lanes[0], lanes[1], lanes[2], lanes[3], frame.size()});
}

}  // namespace shoal::replay
