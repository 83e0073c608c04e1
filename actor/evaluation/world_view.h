// SPDX-License-Identifier: Apache-2.0
// The larger view of one of Shoal's worlds. An environment of its own plays the same episodes by
// the same actions: equal stream keys and actions give equal physics, so the policy's environment
// needs no knowledge of the view. The view shows the goal's marker, whether or not the policy's
// pictures do.
#pragma once

#include <memory>

#include "actor/evaluation/episode_view.h"
#include "actor/evaluation/frame_recorder.h"
#include "common/config/run_config.h"

namespace shoal::actor {

// Its Begin and Step CHECK that both environments earn the same. Throws Error (kUsage) on a camera
// that the task does not have.
std::unique_ptr<EpisodeView> MakeWorldView(const RunConfig& run,
                                           const FrameRecorder::Options& options);

}  // namespace shoal::actor
