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
  // The time of drawing a frame, all cameras, on this machine, and of a whole env step with it.
  double frame_microseconds = 0, step_microseconds = 0;
};

struct DescribedEnvironment {
  tasks::EnvironmentDescription description;
  int steps = 0;                    // that were tried
  double step_microseconds = 0;     // duration of one
  int repeated_steps = 0;           // that were played again with the same seed and actions
  std::optional<int> differs_at{};  // the first that was another the second time; 0 = the reset
};

// The environment of env.id as its interpreter describes it. Plays one episode of random actions,
// or its first seconds. Throws Error, with the actor's exit code, when it cannot be made or does
// not keep to its spaces.
DescribedEnvironment DescribeEnvironment(const Config& config);

// `shoal-actor --describe`: what actors of this configuration observe. Its error becomes ours, with
// its exit code.
ObservedWorld DescribeObservations(const Config& config);

// Destination of an evaluation's frames (common/image/frame_stream.h).
struct ShownFrames {
  std::filesystem::path stream = {};  // file or pipe; empty = nowhere
  int side = 0;                       // height and width of the larger view, pixels
  std::string quality = {};           // of the larger view; empty = by the run's
};

struct EvaluationOrder {
  std::filesystem::path run, checkpoint;
  int episodes = 0;
  int64_t seed = 0;
  std::string task = {};            // to play instead of the run's; empty = the run's
  std::filesystem::path json = {};  // where the result goes; empty = nowhere
  ShownFrames frames = {};
  bool own_run = false;  // the caller holds the run: temporary files go into its folder
  bool partial = false;  // stopped, what was played by then counts
  // Told every few seconds how far it is, "37 of 100 episodes", if it is farther than before.
  std::function<void(const std::string& line)> progress = {};
};

// `shoal-actor --evaluate`: fresh episodes of the final stream with a checkpoint. Throws Error when
// it fails; empty when `stop` ended it, but for `partial` once an episode was played: of fewer
// episodes, then, the first ones of those that were asked for. `json` must not exist, then.
std::optional<EvaluationPoint> EvaluateByActor(const EvaluationOrder& order,
                                               const std::function<bool()>& stop);

}  // namespace shoal::launch
