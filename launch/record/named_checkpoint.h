// SPDX-License-Identifier: Apache-2.0
// Finds the checkpoint that a command line names, for every command that has a checkpoint argument.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// At least one of `run` and `checkpoint` is given.
struct CheckpointWords {
  std::string run = {};  // name within run_dir, or path of a folder
  // Together with `run`: a name in the run's checkpoints/ folder. Alone: the same values as `run`.
  std::string checkpoint = {};
  std::string run_dir = "runs";
};

struct NamedCheckpoint {
  std::filesystem::path run;  // the checkpoint's run; empty for a folder outside of a run
  std::filesystem::path checkpoint;
};

// Finds the checkpoint. If only a run is given, this is the run's judged checkpoint: the best, or
// the newest if there is no best. A path may also be RUN/checkpoints/NAME, where RUN is a run's
// name or folder, or a checkpoint's folder outside of a run. Returned paths are absolute. Throws a
// usage error with the searched folders if nothing has this name, and a run-time error if the run
// has no checkpoint yet.
NamedCheckpoint FindCheckpoint(const CheckpointWords& words);

}  // namespace shoal::launch
