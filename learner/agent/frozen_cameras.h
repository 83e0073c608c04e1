// SPDX-License-Identifier: Apache-2.0
// Detects frozen cameras: all their newest frames in a random sample of the replay show the same
// image. Frames are randomly shifted, so two frames are compared at every relative offset that two
// shifts can have, at pixels where neither frame shows padding.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal::learner {

// `stacks`: (N, K*C, H, W) u8 of `spec`, each shifted by at most `shift_pad` pixels in each
// direction. Compares the first kComparedStacks of them. Returns the number of cameras that are
// frozen in all of these; 0 if N < 2 or if padding may reach the middle of an image.
int FrozenCameras(std::span<const uint8_t> stacks, const ObservationSpec& spec, int shift_pad);

inline constexpr int kComparedStacks = 8;

}  // namespace shoal::learner
