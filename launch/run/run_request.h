// SPDX-License-Identifier: Apache-2.0
// A run that `shoal train` is about to start. A fresh run and a resumed run fill this value in
// different ways; training_run.cpp checks and starts both kinds in the same way.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/config/run_config.h"
#include "common/nn/safetensors.h"
#include "launch/processes/hosts_file.h"
#include "launch/record/run_folder.h"
#include "launch/record/run_meta.h"
#include "launch/run/train_options.h"
#include "launch/watch/best_split.h"

namespace shoal::launch {

struct RunRequest {
  RunConfig config;
  Hosts hosts{};
  RunMeta meta{};
  // The folder of a resumed run, locked from the beginning. The folder of a fresh run is created
  // last (TakeFolder), so that a refused run leaves no folder.
  std::optional<RunFolder> folder{};
  double frame_microseconds = 0;              // time to draw a frame, all cameras
  std::optional<SplitLimits> split_limits{};  // for later divisions of the cores (core_split.h)
  std::string camera_note{};                  // one line; empty unless the task chose the cameras
  std::string environment_note{};             // one line; empty unless env.id names an environment
  nn::TensorMap initial_weights{};  // of --init-from, by Shoal's names; empty without the option

  bool resumed() const { return folder.has_value(); }
};

// Resolves a fresh run. With --print-config only the configuration is resolved. Throws Error.
RunRequest ResolveFresh(const TrainOptions& options);

// Returns the run's folder: creates the folder of a fresh run and writes the initial weights, or
// moves the folder of a resumed run out of the request. Completes `request->config` and
// `request->meta`. Throws Error.
RunFolder TakeFolder(const TrainOptions& options, RunRequest* request);

// Waits until the processes of an earlier session have exited, because processes whose coordinator
// was killed write into the folder for some time. Prints the processes for which the function
// waits. Throws Error.
void WaitUntilUnused(const std::filesystem::path& run);

}  // namespace shoal::launch
