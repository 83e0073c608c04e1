// SPDX-License-Identifier: Apache-2.0
// The checks of a run before its folder is created and its processes are started. Each check finds
// an error that a process of the run would otherwise find later, and refuses the run with one line.
#pragma once

#include <string>

#include "launch/run/run_request.h"
#include "launch/run/train_options.h"

namespace shoal::launch {

// Throws Error if this process may open only few files, because the DDS library would fail without
// giving the reason.
void CheckOpenFiles();

// Checks the network, the initial weights of a fresh run (read into the request), the replay's
// storage and the other hosts. Throws Error.
void CheckRequest(const TrainOptions& options, RunRequest* request);

// Checks the credentials of every process that a secured run starts. `secure`: their folder; empty
// for a run that is not secured. Throws Error.
void CheckRunCredentials(const std::string& secure);

}  // namespace shoal::launch
