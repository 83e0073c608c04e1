// SPDX-License-Identifier: Apache-2.0
// Cameras that see nothing change: their newest frames in a random sample of the replay are the
// same picture. Frames come randomly shifted, so two of them are compared at every relative offset
// that two shifts can have, where neither shows padding.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal::learner {

// `stacks`: (N, K*C, H, W) u8 of `spec`, each shifted by at most `shift_pad` pixels either way; the
// first kComparedStacks are looked at. The number of cameras frozen in all of them; 0 where N < 2
// or padding may reach the middle of an image.
int FrozenCameras(std::span<const uint8_t> stacks, const ObservationSpec& spec, int shift_pad);

inline constexpr int kComparedStacks = 8;

}  // namespace shoal::learner
