// SPDX-License-Identifier: Apache-2.0
// Calls of the actor program outside a run's processes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "common/tasks/environment_description.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

struct ObservedWorld {
  ObservationSpec spec;
  // Time on this machine to draw a frame (all cameras), and to make a whole env step with its
  // frame.
  double frame_microseconds = 0, step_microseconds = 0;
};

struct DescribedEnvironment {
  tasks::EnvironmentDescription description;
  int steps = 0;                    // number of steps played
  double step_microseconds = 0;     // duration of one step
  int repeated_steps = 0;           // steps repeated with the same seed and actions
  std::optional<int> differs_at{};  // first step that differed when repeated; 0 = the reset
};

// Describes the environment of env.id, in its interpreter. Plays one episode of random actions, or
// the first seconds of an episode. Throws Error, with the actor's exit code, if the environment
// cannot be created or violates its spaces.
DescribedEnvironment DescribeEnvironment(const Config& config);

// `shoal-actor --describe`: the observations of this configuration's actors. Throws the program's
// error, with its exit code.
ObservedWorld DescribeObservations(const Config& config);

// Destination of an evaluation's frames (common/image/frame_stream.h).
struct ShownFrames {
  std::filesystem::path stream = {};  // file or pipe; empty = nowhere
  int side = 0;                       // height and width of the larger view, pixels
  std::string quality = {};           // of the larger view; empty = the run's quality
};

struct EvaluationOrder {
  std::filesystem::path run, checkpoint;
  int episodes = 0;
  int64_t seed = 0;
  std::string task = {};            // empty = the run's task
  std::filesystem::path json = {};  // file for the result; empty = none
  ShownFrames frames = {};
  bool own_run = false;  // the caller holds the run: temporary files are in the run's folder
  bool partial = false;  // if stopped, the episodes played so far are the result
  // Called every few seconds with the progress, "37 of 100 episodes", if it has changed.
  std::function<void(const std::string& line)> progress = {};
};

// `shoal-actor --evaluate`: plays fresh episodes of the final stream with a checkpoint. Throws
// Error if the program fails. If `stop` ended the program, returns nothing, except that `partial`
// returns the result of the episodes played so far, if any. `json` must not exist before the call.
std::optional<EvaluationPoint> EvaluateByActor(const EvaluationOrder& order,
                                               const std::function<bool()>& stop);

}  // namespace shoal::launch
