// SPDX-License-Identifier: Apache-2.0
// Lines of `shoal check` about the machine: instruction set, cores, space on disk and in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/usable_cores.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

// `isa` and `precision`: names of common/nn, such as "avx512_core_bf16" and "bf16".
CheckLine JudgeCpu(const std::string& isa, const std::string& precision);

CheckLine JudgeCores(const CoreLimits& limits);

// The GPU for learner.device = cuda, or why there is none. Training needs no GPU.
CheckLine LookAtGpu();

// Names the distribution and reports whether building and training were tested on it
// (docs/install.md). `release_files` are tried in order: /etc/os-release, /usr/lib/os-release.
CheckLine JudgeSystem(const std::vector<std::filesystem::path>& release_files);

// Space and transfer rate that a run of the default preset needs.
struct Needs {
  uint64_t ring_bytes = 0;     // ring of the replay, a file in the run folder
  double loopback_rate = 0;    // records sent over loopback to the replay, bytes/s
  uint64_t process_bytes = 0;  // memory of all processes without the ring
};

// Free space for the ring in `run_dir` or, if `run_dir` does not exist yet, in its nearest existing
// parent.
CheckLine LookAtDisk(const std::filesystem::path& run_dir, const Needs& needs);
// The path, or its nearest existing parent folder.
std::filesystem::path ExistingFolder(const std::filesystem::path& path);

// `available`: available memory in bytes; `source`: name of the limit. The ring is fast only if its
// pages stay in memory.
CheckLine JudgeMemory(uint64_t available, const std::string& source, const Needs& needs);

// Free space in `folder` ("/dev/shm"). The line is shown because users look for this value; no
// process uses the folder.
CheckLine LookAtSharedMemory(const std::filesystem::path& folder);

}  // namespace shoal::launch
