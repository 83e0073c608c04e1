// SPDX-License-Identifier: Apache-2.0
// The processes of a run as threads of this process (shoal train --in-process): the same services
// over a link in memory, with the same files and logs. Used with debuggers, and in tests without
// child processes.
//
// One run per process, because MuJoCo's error callbacks, OpenMP's pool, the renderer and task
// libraries have state that belongs to the process.
#pragma once

#include <filesystem>
#include <memory>

#include "common/config/run_config.h"
#include "common/link/local_network.h"
#include "launch/processes/running_process.h"

namespace shoal::launch {

class InProcessRoles {
 public:
  // `folder`: the run's folder. Loads the physics of the run's tasks. Throws Error.
  InProcessRoles(const std::filesystem::path& folder, const Config& config);

  // Starts threads for the process, which is a replay, a learner, an actor or the evaluation actor.
  // A stop signal becomes a stop request to the thread group of the process. SIGKILL has no
  // equivalent for threads: SIGKILL ends this whole process with one line, and the run can be
  // resumed. The result borrows this object.
  std::unique_ptr<RunningProcess> Start(const ProcessSpec& spec);

  // The coordinator's endpoint of the link.
  link::Hub& coordinator() { return *coordinator_; }

 private:
  int Run(const ProcessSpec& spec);

  const std::filesystem::path folder_;
  link::LocalNetwork network_;
  const std::unique_ptr<link::Hub> coordinator_;
};

// Prepares this process for --in-process: executes the program again with the environment variables
// that OpenMP and the renderer read when they are loaded. Call before any thread is created. Throws
// Error.
void PrepareForRolesInProcess();

}  // namespace shoal::launch
