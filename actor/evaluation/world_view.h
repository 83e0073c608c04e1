// SPDX-License-Identifier: Apache-2.0
// The larger view of one of Shoal's worlds. The view has a separate environment, which plays the
// same episodes with the same actions: equal stream keys and actions give equal physics. The
// policy's environment is therefore independent of the view. The view shows the goal's marker even
// if the policy's pictures do not.
#pragma once

#include <memory>

#include "actor/evaluation/episode_view.h"
#include "actor/evaluation/frame_recorder.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// Makes the view. Step of the view CHECKs that both environments return the same reward. Throws
// Error (kUsage) if the task does not have the camera.
std::unique_ptr<EpisodeView> MakeWorldView(const RunConfig& run,
                                           const FrameRecorder::Options& options);

}  // namespace shoal::actor
