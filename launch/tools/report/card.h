// SPDX-License-Identifier: Apache-2.0
// `shoal card`: a run as a folder that model hubs take: README.md with their metadata,
// results.json, config.json, policy.safetensors, replay.mp4 where the run has a film.
#pragma once

#include <filesystem>

namespace shoal::launch {

// Makes `folder` of the run's judged checkpoint and its final evaluation. Throws Error naming what
// is missing (the final evaluation, the checkpoint) or the folder, which must not be there yet;
// then nothing is left behind.
void WriteCard(const std::filesystem::path& run, const std::filesystem::path& folder);

}  // namespace shoal::launch
