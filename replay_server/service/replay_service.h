// SPDX-License-Identifier: Apache-2.0
// The replay server process: the core, owned by the thread that calls Run(), between DDS receive
// threads (service_inbox.h) and the batch sender's thread (batch_sender.h).
#pragma once

#include <filesystem>

#include "common/dds/reach.h"

namespace shoal::replay {

// Serves the run in `folder` until the coordinator says stop (0), SIGTERM comes (0), or the
// coordinator is gone (1: what the actors still send is stored first). Leaves accounting.json.
// Throws Error.
int RunReplayService(const std::filesystem::path& folder, const dds::Reach& reach);

}  // namespace shoal::replay
