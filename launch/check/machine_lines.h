// SPDX-License-Identifier: Apache-2.0
// Lines of `shoal check` about the machine: arithmetic, cores, space on disk and in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/usable_cores.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

// `isa` and `precision` as common/nn names them: "avx512_core_bf16", "bf16".
CheckLine JudgeCpu(const std::string& isa, const std::string& precision);

CheckLine JudgeCores(const CoreLimits& limits);

// Names the distribution, and says whether building and training were tried on it
// (docs/install.md). `release_files` are looked for in turn: /etc/os-release, /usr/lib/os-release.
CheckLine JudgeSystem(const std::vector<std::filesystem::path>& release_files);

// Space that a run of the default preset needs.
struct Needs {
  uint64_t ring_bytes = 0;     // of the replay, a file in the run folder
  double loopback_rate = 0;    // bytes/s of records, over loopback to the replay
  uint64_t process_bytes = 0;  // of memory for all processes, without the ring
};

// Room for the ring in `run_dir` or, as long as that is not there, in the folder it will be made
// in.
CheckLine LookAtDisk(const std::filesystem::path& run_dir, const Needs& needs);
// Nearest folder of a path that is there.
std::filesystem::path ExistingFolder(const std::filesystem::path& path);

// `available`: bytes, limited by `source`. The ring's pages want to stay in memory.
CheckLine JudgeMemory(uint64_t available, const std::string& source, const Needs& needs);

// Room in `folder` ("/dev/shm"), told because people look for it: no process uses it.
CheckLine LookAtSharedMemory(const std::filesystem::path& folder);

}  // namespace shoal::launch
