// SPDX-License-Identifier: Apache-2.0
// Check word of a stored frame. Any single flipped bit changes the check word, because each step is
// a bijection of its word and of its lane. Other damage stays undetected with a probability of
// about 2^-64. The check is not cryptographic. It uses four interleaved lanes to run at memory
// speed: a frame is checked each time it is stored and each time a ring file is opened.
//
//   lane_j = rotl(lane_j + odd * word_(4 i + j), 31) * odd', for i = 0, 1, ...; j = 0..3
//   check = HashWords(lane_0, lane_1, lane_2, lane_3, bytes)
//
// Words are little-endian; the last one is padded with zeros. Ring files contain check words, so
// any change of the formula needs a new kRingVersion.
#pragma once

#include <cstdint>
#include <span>

namespace shoal::replay {

uint64_t FrameCheck(std::span<const uint8_t> frame);

}  // namespace shoal::replay
