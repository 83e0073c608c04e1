// SPDX-License-Identifier: Apache-2.0
// Draws samples from the ring of a run as the learner would get them. `shoal replay peek` shows
// them as a picture, with and without the random shift; `shoal export` uses the observations only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::replay {

// The message "there is no 'FILE': ...", with advice on keeping the ring.
std::string DescribeMissingRing(const std::filesystem::path& file);
// Throws Error (usage) with the text of DescribeMissingRing if there is no ring file.
void CheckRingIsThere(const std::filesystem::path& file);

struct Peek {
  uint64_t records = 0;     // in the ring now
  uint64_t sampleable = 0;  // steps among the records that can be sampled
  // Picture: (height, width, 3) uint8 RGB, row 0 = top. One column per element. Four rows per
  // camera: obs, obs shifted, next_obs, next_obs shifted, each the newest frame of its stack. With
  // goal pictures a fifth row shows the goal of the element, not shifted. Empty for a spec without
  // pixels.
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  std::vector<std::string> captions;  // per element: record id, env, episode, index, reward, ends
};

// Draws `batch` elements from the ring of the run in `folder`; a server may be writing to it.
// Throws Error when there is no ring file, it does not fit the run, or it holds no sampleable step.
Peek PeekBatch(const std::filesystem::path& folder, int batch, uint64_t seed);

struct PeekedObservations {
  std::vector<uint8_t> frames;  // (batch, I, H, W), not shifted; empty without pixels
  std::vector<float> vectors;   // (batch, V)
};

// The observations before `batch` steps, drawn as in PeekBatch. Throws Error like PeekBatch.
PeekedObservations PeekObservations(const std::filesystem::path& folder, int batch, uint64_t seed);

}  // namespace shoal::replay
