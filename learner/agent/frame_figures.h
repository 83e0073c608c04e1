// SPDX-License-Identifier: Apache-2.0
// Figures of the images of a batch, by camera, for every algorithm.
#pragma once

#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

inline constexpr Figure kFrameSpread{"frame_spread", "grey levels",
                                     "standard deviation of a frame's pixels; with pixels", false,
                                     ""};
inline constexpr Figure kFrozenCameras{
    "frozen_cameras", "", "that show one picture throughout a batch; with pixels", false, ""};
inline constexpr const Figure* kFrameFigures[] = {&kFrameSpread, &kFrozenCameras};

// Appends both figures; appends none without pixels. A batch is a random sample, so its first
// frames represent all. `shift_pad`: the largest random shift of its frames.
void AddFrameFigures(const BatchView& batch, const ObservationSpec& spec, int shift_pad,
                     UpdateFigures* figures);

}  // namespace shoal::learner
