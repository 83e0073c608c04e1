// SPDX-License-Identifier: Apache-2.0
// The checks of a run before anything of it is made or started: each refuses with one line what a
// process of the run would otherwise find later.
#pragma once

#include <string>

#include "launch/run/run_request.h"
#include "launch/run/train_options.h"

namespace shoal::launch {

// This process may open few files: the DDS library would fail without a reason. Throws Error.
void CheckOpenFiles();

// The network, the weights that a fresh run starts from (read into the request), the replay's
// storage and the other hosts. Throws Error.
void CheckRequest(const TrainOptions& options, RunRequest* request);

// The credentials of every process that a secured run starts; `secure` is their folder, empty for a
// run that is not secured. Throws Error.
void CheckRunCredentials(const std::string& secure);

}  // namespace shoal::launch
