// SPDX-License-Identifier: Apache-2.0
// Which checkpoint a command line means. One function for every command that takes one.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// At least one of `run` and `checkpoint` is given.
struct CheckpointWords {
  std::string run = {};  // name within run_dir, or path of a folder
  // Together with `run`: a name in its checkpoints/ folder. Alone: takes the same words as `run`.
  std::string checkpoint = {};
  std::string run_dir = "runs";
};

struct NamedCheckpoint {
  std::filesystem::path run;  // that it belongs to; empty for a folder outside of a run
  std::filesystem::path checkpoint;
};

// A run means the checkpoint that it is judged by (best, else the newest); a path may also be
// RUN/checkpoints/NAME, where RUN is a run's name or folder, or a checkpoint's folder outside of a
// run. Paths are absolute. Throws Error: usage where the words name nothing, with what was looked
// at; run-time where the run has no checkpoint yet.
NamedCheckpoint FindCheckpoint(const CheckpointWords& words);

}  // namespace shoal::launch
