// SPDX-License-Identifier: Apache-2.0
// A run that `shoal train` is about to start: the value that a fresh run and a resumed one fill in
// their own ways, and that is then checked and started in one way (training_run.cpp).
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
  // A resumed run's, held from the beginning. A fresh run gets its own last (TakeFolder), so that a
  // refusal leaves nothing behind.
  std::optional<RunFolder> folder{};
  double frame_microseconds = 0;              // to draw a frame, all cameras
  std::optional<SplitLimits> split_limits{};  // within which the run divides the cores anew
  std::string camera_note{};                  // one line; empty unless the task chose the cameras
  std::string environment_note{};             // one line; empty unless env.id names an environment
  nn::TensorMap initial_weights{};            // --init-from, by our names; empty without

  bool resumed() const { return folder.has_value(); }
};

// Resolves a fresh run. With --print-config only the configuration is resolved. Throws Error.
RunRequest ResolveFresh(const TrainOptions& options);

// The folder to start in, with the initial weights in it: creates that of a fresh run, and gives
// away that of a resumed one. Completes `request->config` and `request->meta`. Throws Error.
RunFolder TakeFolder(const TrainOptions& options, RunRequest* request);

// Waits until the processes of an earlier session have left the run. After their coordinator was
// killed, they write into its folder until they notice. Prints what it waits for. Throws Error.
void WaitUntilUnused(const std::filesystem::path& run);

}  // namespace shoal::launch
