// SPDX-License-Identifier: Apache-2.0
// `shoal film`: makes an MP4 file of episodes that a run's checkpoints play.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/film/film_strip.h"

namespace shoal::launch {

struct FilmOrder {
  std::filesystem::path run;
  std::vector<std::filesystem::path> checkpoints;  // shown one after the other
  int episodes = 0;                                // number of episodes of each checkpoint
  int64_t seed = 0;  // selects the same episodes as in a final evaluation
  std::filesystem::path output;
  std::string quality = {};  // of the larger view: fast | native | reference; empty = as the run
  bool strips = false;       // true: also makes a strip of each checkpoint's first episode
};

// Pictures of an episode side by side (film_strip.h).
struct CheckpointStrip {
  uint64_t env_steps = 0;  // of the checkpoint
  StripImage image;
};

struct FilmMade {
  uint64_t frames = 0;
  double seconds = 0;
  uintmax_t bytes = 0;
  std::vector<CheckpointStrip> strips{};  // in the order of the checkpoints
};

// RUN/videos/NAME.mp4
std::filesystem::path FilmPath(const std::filesystem::path& run, const std::string& name);

// Throws Error (usage) if a film cannot have this name, or if CheckWritable refuses its folder.
void CheckFilmOutput(const std::filesystem::path& run, const std::filesystem::path& output);

// Plays the episodes with `shoal-actor --evaluate --frames` and encodes the frames as they arrive.
// `say` receives a line per checkpoint. Empty if `stop` ended the film. Throws Error. The file is
// complete or does not exist.
std::optional<FilmMade> MakeFilm(const FilmOrder& order, const std::function<bool()>& stop,
                                 const std::function<void(const std::string&)>& say);

}  // namespace shoal::launch
