// SPDX-License-Identifier: Apache-2.0
// Metrics of the images of a batch, for every algorithm.
#pragma once

#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

inline constexpr Figure kFrameSpread{"frame_spread", "grey levels",
                                     "standard deviation of a frame's pixels; with pixels", false,
                                     ""};
inline constexpr Figure kFrozenCameras{
    "frozen_cameras", "", "cameras that show the same picture throughout a batch; with pixels",
    false, ""};
inline constexpr const Figure* kFrameFigures[] = {&kFrameSpread, &kFrozenCameras};

// Appends the two metrics; appends no metric without pixels. Only the first frames of the batch are
// read, because a batch is a random sample. `shift_pad`: the largest random shift of the frames.
void AddFrameFigures(const BatchView& batch, const ObservationSpec& spec, int shift_pad,
                     UpdateFigures* figures);

}  // namespace shoal::learner
