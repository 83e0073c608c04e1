// SPDX-License-Identifier: Apache-2.0
// Draws samples from the ring of a run, as they are drawn for the learner. `shoal replay peek`
// shows the samples as a picture, with and without the random shift. `shoal export` uses only the
// observations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::replay {

// The message "there is no 'FILE': ...", with advice how to keep the ring of a run.
std::string DescribeMissingRing(const std::filesystem::path& file);
// Throws Error (kUsage) with the text of DescribeMissingRing if there is no ring file.
void CheckRingIsThere(const std::filesystem::path& file);

struct Peek {
  uint64_t records = 0;     // in the ring now
  uint64_t sampleable = 0;  // steps among the records that can be sampled
  // Picture: (height, width, 3) uint8 RGB, row 0 = top. One column for each element. Four rows for
  // each camera: obs, shifted obs, next_obs, shifted next_obs; each shows the newest frame of its
  // stack. With goal pictures, a fifth row shows the goal picture, not shifted. Empty for a spec
  // without pixels.
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  std::vector<std::string> captions;  // per element: record id, env, episode, index, reward, ends
};

// Draws `batch` elements from the ring of the run in `folder`. A server may be writing to the ring.
// Throws Error if there is no ring file, if the file does not fit the run, or if the ring has no
// sampleable step.
Peek PeekBatch(const std::filesystem::path& folder, int batch, uint64_t seed);

struct PeekedObservations {
  // (batch, I, H, W), not shifted, with ObservationSpec::InputChannels I; empty without pixels.
  std::vector<uint8_t> frames;
  std::vector<float> vectors;  // (batch, V), with ObservationSpec::VectorSize V
};

// The observations before `batch` steps, drawn as in PeekBatch. Throws Error like PeekBatch.
PeekedObservations PeekObservations(const std::filesystem::path& folder, int batch, uint64_t seed);

}  // namespace shoal::replay
