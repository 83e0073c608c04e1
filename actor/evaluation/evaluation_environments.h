// SPDX-License-Identifier: Apache-2.0
// The source of an evaluation's environments.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "actor/acting/environments.h"
#include "actor/evaluation/episode_view.h"
#include "actor/evaluation/frame_recorder.h"
#include "common/config/run_config.h"

namespace shoal::actor {

struct EvaluationEnvironments {
  EnvironmentFactory make;
  // Returns the run's configuration with another task to play. Throws Error if the policy does not
  // fit the other task.
  std::function<RunConfig(const RunConfig&, const std::string& task)> with_task;
  // Makes the larger view of films. Called after the evaluation's only environment has been made.
  std::function<std::unique_ptr<EpisodeView>(const RunConfig&, const FrameRecorder::Options&)> view;
};

// Shoal's own worlds.
EvaluationEnvironments WorldEnvironments();

}  // namespace shoal::actor
