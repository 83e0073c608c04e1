// SPDX-License-Identifier: Apache-2.0
// Measures how well a network of the run's kind predicts numbers from frames: an encoder, a trunk
// and linear functions of its output, as sac.aux trains them. Trained by Adam on the mean squared
// error; each frame gets a new random shift.
#pragma once

#include <functional>
#include <vector>

#include "common/config/config.h"
#include "launch/tools/observability/labelled_frames.h"

namespace shoal::launch {

struct RegressionErrors {
  // One value per label, in its unit: root mean squared error over the frames of held-out episodes.
  // `error`: of the network; `of_mean`: of predicting the mean over the training frames.
  std::vector<double> error, of_mean;
  int trained = 0, held_out = 0;  // frames
};

// Trains for `updates` batches of config.learner.batch frames. Network, precision, shift, seed and
// learning rate are the configuration's. The last fifth of the episodes is held out. `stop` is
// called after each update; true ends the training. Throws Error if there are fewer than two
// episodes.
RegressionErrors RegressOnFrames(const Config& config, const LabelledFrames& frames, int updates,
                                 const std::function<bool()>& stop);

}  // namespace shoal::launch
