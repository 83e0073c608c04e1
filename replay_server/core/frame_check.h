// SPDX-License-Identifier: Apache-2.0
// Check word of a stored frame. Every single flipped bit changes the check word, because each step
// is a bijection of its word and of its lane. Other damage stays undetected with a probability of
// about 2^-64. The check is not cryptographic. Frames are checked when they are stored and when a
// ring file is opened. Four interleaved lanes make the check as fast as the memory.
//
//   lane_j = rotl(lane_j + odd * word_(4 i + j), 31) * odd', for i = 0, 1, ...; j = 0..3
//   check = HashWords(lane_0, lane_1, lane_2, lane_3, bytes)
//
// Words have 8 bytes and are little-endian; the last word is padded with zeros. Ring files contain
// check words, so every change of the formula needs a new kRingVersion.
#pragma once

#include <cstdint>
#include <span>

namespace shoal::replay {

uint64_t FrameCheck(std::span<const uint8_t> frame);

}  // namespace shoal::replay
