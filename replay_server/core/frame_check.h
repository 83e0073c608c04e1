// SPDX-License-Identifier: Apache-2.0
// The check word of a stored frame: any single flipped bit changes it, because each step is one to
// one in its word and in its lane; other damage goes unnoticed about once in 2^64. Not
// cryptographic. Four interleaved lanes, so that it runs at memory speed: a frame is checked each
// time it is stored and each time a ring file is opened.
//
//   lane_j = rotl(lane_j + odd * word_(4 i + j), 31) * odd', for i = 0, 1, ...; j = 0..3
//   check = HashWords(lane_0, lane_1, lane_2, lane_3, bytes)
//
// Words are little-endian, the last one padded with zeros. Stored in files: never change it without
// a new kRingVersion.
#pragma once

#include <cstdint>
#include <span>

namespace shoal::replay {

uint64_t FrameCheck(std::span<const uint8_t> frame);

}  // namespace shoal::replay
