// SPDX-License-Identifier: Apache-2.0
// How well a network of a run's kind tells numbers from frames: an encoder, a trunk and linear
// functions of it, as sac.aux trains them, by Adam on the mean square; each frame shifted anew.
#pragma once

#include <functional>
#include <vector>

#include "common/config/config.h"
#include "launch/tools/observability/labelled_frames.h"

namespace shoal::launch {

struct RegressionErrors {
  // Over frames of episodes that were held out, for each label, in its own unit: root mean square
  // of what the network is off by, and of what the mean of the trained ones is.
  std::vector<double> error, of_mean;
  int trained = 0, held_out = 0;  // frames
};

// `updates` of config.learner.batch frames; network, precision, shift, seed and learning rate are
// the configuration's. The last fifth of the episodes is held out. `stop`: asked after each update;
// true ends the training. Throws Error where fewer than two episodes are there.
RegressionErrors RegressOnFrames(const Config& config, const LabelledFrames& frames, int updates,
                                 const std::function<bool()>& stop);

}  // namespace shoal::launch
