// SPDX-License-Identifier: Apache-2.0
// Measures how well a network predicts numbers from frames. As with sac.aux, the network has an
// encoder, a trunk and linear functions of the trunk's output. Adam trains the network on the mean
// squared error; each frame gets a new random shift.
#pragma once

#include <functional>
#include <vector>

#include "common/config/config.h"
#include "launch/tools/observability/labelled_frames.h"

namespace shoal::launch {

struct RegressionErrors {
  // One value per label, in the label's unit: root mean squared error over the frames of held-out
  // episodes. `error`: error of the network; `of_mean`: error if the mean over the training frames
  // is predicted.
  std::vector<double> error, of_mean;
  int trained = 0, held_out = 0;  // numbers of frames
};

// Trains for `updates` batches of config.learner.batch frames. Network, precision, shift, seed and
// learning rate are those of the configuration. The last fifth of the episodes is held out. `stop`
// is called after each update; if `stop` returns true, the training ends. Throws Error if there are
// fewer than two episodes.
RegressionErrors RegressOnFrames(const Config& config, const LabelledFrames& frames, int updates,
                                 const std::function<bool()>& stop);

}  // namespace shoal::launch
