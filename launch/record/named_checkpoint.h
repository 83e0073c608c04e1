// SPDX-License-Identifier: Apache-2.0
// Finds the checkpoint that a command line names, for every command that has a checkpoint argument.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// At least one of `run` and `checkpoint` is given.
struct CheckpointWords {
  std::string run = {};  // name within run_dir, or path of a folder
  // Together with `run`: a name in its checkpoints/ folder. Alone: the same values as `run`.
  std::string checkpoint = {};
  std::string run_dir = "runs";
};

struct NamedCheckpoint {
  std::filesystem::path run;  // its run; empty for a folder outside of a run
  std::filesystem::path checkpoint;
};

// A run stands for its judged checkpoint (the best, else the newest). A path may also be
// RUN/checkpoints/NAME, where RUN is a run's name or folder, or a checkpoint's folder outside of a
// run. Returned paths are absolute. Throws Error: a usage error with the searched folders if
// nothing has this name, a run-time error if the run has no checkpoint yet.
NamedCheckpoint FindCheckpoint(const CheckpointWords& words);

}  // namespace shoal::launch
