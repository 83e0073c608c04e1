// SPDX-License-Identifier: Apache-2.0
// The processes of a run as threads of this one (shoal train --in-process): the same services over
// a link in memory, with the same files and logs. For debuggers, and for tests without processes.
//
// One run per process: what the engine (MuJoCo's error callbacks), OpenMP (its pool), the renderer
// and task libraries keep is the process's.
#pragma once

#include <filesystem>
#include <memory>

#include "common/config/run_config.h"
#include "common/link/local_network.h"
#include "launch/processes/running_process.h"

namespace shoal::launch {

class InProcessRoles {
 public:
  // For the run in `folder`. Loads its tasks' physics. Throws Error.
  InProcessRoles(const std::filesystem::path& folder, const Config& config);

  // Starts threads for the process, which is a replay, a learner, an actor or the evaluation actor.
  // Its stop signals are requests to its thread group; SIGKILL, of which threads have no like, ends
  // this whole process with one line, and the run can be resumed. The result borrows this object.
  std::unique_ptr<RunningProcess> Start(const ProcessSpec& spec);

  // The coordinator's place on the link.
  link::Hub& coordinator() { return *coordinator_; }

 private:
  int Run(const ProcessSpec& spec);

  const std::filesystem::path folder_;
  link::LocalNetwork network_;
  const std::unique_ptr<link::Hub> coordinator_;
};

// Prepares this process for --in-process, which OpenMP and the renderer want before they are
// loaded: starts the program anew, once, with their environment. Call before any thread is made.
// Throws Error.
void PrepareForRolesInProcess();

}  // namespace shoal::launch
