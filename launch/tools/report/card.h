// SPDX-License-Identifier: Apache-2.0
// `shoal card`: exports a run as a folder for model hubs: README.md with the hub's metadata,
// results.json, config.json, policy.safetensors, and replay.mp4 if the run has a film.
#pragma once

#include <filesystem>

namespace shoal::launch {

// Creates `folder` from the run's judged checkpoint and final evaluation. If one of these is
// missing, or if the folder exists already, throws Error naming the missing part or the folder.
// After an error there are no new files.
void WriteCard(const std::filesystem::path& run, const std::filesystem::path& folder);

}  // namespace shoal::launch
