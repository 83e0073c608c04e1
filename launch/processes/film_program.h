// SPDX-License-Identifier: Apache-2.0
// `shoal film` as a child process. The process that starts the command does not need the film
// libraries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace shoal::launch {

struct FilmCommand {
  std::filesystem::path checkpoint;  // RUN/checkpoints/NAME
  int episodes = 0;
  int64_t seed = 0;              // selects the episodes, like the seed of a final evaluation
  std::filesystem::path output;  // .mp4
};

// Makes the film. Returns false if `stop` ended the command; then there is no film. `say` gets each
// line that the command reports. Throws Error if the command fails or exceeds the time limit for
// its episodes.
bool FilmByCommand(const FilmCommand& command, const std::function<bool()>& stop,
                   const std::function<void(const std::string& line)>& say);

}  // namespace shoal::launch
