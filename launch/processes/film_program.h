// SPDX-License-Identifier: Apache-2.0
// `shoal film` as a child process. The run that starts it needs none of the libraries of films.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace shoal::launch {

struct FilmCommand {
  std::filesystem::path checkpoint;  // RUN/checkpoints/NAME
  int episodes = 0;
  int64_t seed = 0;              // names the episodes, as that of a final evaluation does
  std::filesystem::path output;  // .mp4
};

// False if `stop` ended it; then there is no film. `say` gets each line that the command reports.
// Throws Error if it fails or takes longer than its episodes allow.
bool FilmByCommand(const FilmCommand& command, const std::function<bool()>& stop,
                   const std::function<void(const std::string& line)>& say);

}  // namespace shoal::launch
