// SPDX-License-Identifier: Apache-2.0
// A look into the ring of a run: what the learner would be given. For `shoal replay peek` as a
// picture, with and without the random shift; for `shoal export` the observations alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::replay {

// "there is no 'FILE': ...", with how to keep it.
std::string DescribeMissingRing(const std::filesystem::path& file);
// Throws Error (usage) with that text.
void CheckRingIsThere(const std::filesystem::path& file);

struct Peek {
  uint64_t records = 0;     // in the ring now
  uint64_t sampleable = 0;  // steps of these that can be sampled
  // Picture: (height, width, 3) uint8 RGB, row 0 = top. One column per element. Four rows per
  // camera: obs, obs shifted, next_obs, next_obs shifted, each the newest frame of its stack; a
  // fifth with goal pictures: the goal that the element has, not shifted. Empty for a spec without
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

// The observations before `batch` steps, drawn as PeekBatch draws them; throws Error as it does.
PeekedObservations PeekObservations(const std::filesystem::path& folder, int batch, uint64_t seed);

}  // namespace shoal::replay
