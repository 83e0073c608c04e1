// SPDX-License-Identifier: Apache-2.0
// Detects frozen cameras. A camera is frozen if all its newest frames in a random sample of the
// replay show the same image. Frames are randomly shifted. Two frames are therefore compared at
// every relative offset that two shifts can have, at the pixels where neither frame has padding.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal::learner {

// `stacks`: N stacks of K frames (C, H, W), as (N, K*C, H, W) u8. Each stack is shifted by at most
// `shift_pad` pixels in each direction. Compares the first kComparedStacks stacks. Returns the
// number of cameras that are frozen in all compared stacks; 0 if N < 2 or if padding may reach the
// middle of an image.
int FrozenCameras(std::span<const uint8_t> stacks, const ObservationSpec& spec, int shift_pad);

inline constexpr int kComparedStacks = 8;

}  // namespace shoal::learner
