// SPDX-License-Identifier: Apache-2.0
// `shoal card`: exports a run as a folder for model hubs: README.md with the hub's metadata,
// results.json, config.json, policy.safetensors, and replay.mp4 if the run has a film.
#pragma once

#include <filesystem>

namespace shoal::launch {

// Makes `folder` from the run's judged checkpoint and its final evaluation. Throws Error naming the
// missing part (the final evaluation, the checkpoint), or naming the folder if it exists already.
// An error leaves no new files.
void WriteCard(const std::filesystem::path& run, const std::filesystem::path& folder);

}  // namespace shoal::launch
