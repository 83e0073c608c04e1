// SPDX-License-Identifier: Apache-2.0
// Observations for comparing two implementations of one policy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/nn/vector_scale.h"
#include "common/spec/observation_spec.h"

namespace shoal::launch {

struct ObservationSet {
  int count = 0;                     // N
  std::vector<uint8_t> frames = {};  // (N, K*C, H, W); empty without pixels
  std::vector<float> vectors = {};   // (N, V)
};

// Images are noise, each in its own range of brightness. Vectors are normally distributed with mean
// 0 and standard deviation 1. If the policy normalises vectors, `scale` gives the mean and the
// standard deviation instead, and a tenth of the numbers is 30 times as far from the mean, so that
// clipping is tested.
ObservationSet RandomObservations(const ObservationSpec& spec,
                                  const std::optional<nn::VectorScale>& scale, int count,
                                  uint64_t seed);

// Recorded observations from the ring of the run that contains `checkpoint` (RUN/checkpoints/NAME
// or RUN/checkpoints/candidates/NAME). If the run has no ring or the ring has another spec, returns
// empty and writes the reason to `why`.
std::optional<ObservationSet> RecordedObservations(const std::filesystem::path& checkpoint,
                                                   const ObservationSpec& spec, int count,
                                                   uint64_t seed, std::string* why);

// Columns of the policy's vector: each observed block (N, size), by its name.
std::map<std::string, std::vector<float>> BlocksOf(const ObservationSpec& spec,
                                                   const ObservationSet& observations);

}  // namespace shoal::launch
