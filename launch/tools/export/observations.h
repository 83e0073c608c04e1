// SPDX-License-Identifier: Apache-2.0
// Observations on which two computations of one policy are compared.
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

// Images are noise, each in a brightness range of its own. Vectors are normal with mean 0 and
// deviation 1. If the policy normalises vectors, theirs are the mean and deviation of `scale`, and
// a tenth of the numbers is 30 times as far from the mean, so that clipping shows.
ObservationSet RandomObservations(const ObservationSpec& spec,
                                  const std::optional<nn::VectorScale>& scale, int count,
                                  uint64_t seed);

// Observations of actors, from the ring of the run that contains `checkpoint`
// (RUN/checkpoints/NAME or RUN/checkpoints/candidates/NAME). Empty if there is no such ring, or one
// of another spec; `why` gets the reason.
std::optional<ObservationSet> RecordedObservations(const std::filesystem::path& checkpoint,
                                                   const ObservationSpec& spec, int count,
                                                   uint64_t seed, std::string* why);

// Columns of the policy's vector: of each observed block (N, size), by its name.
std::map<std::string, std::vector<float>> BlocksOf(const ObservationSpec& spec,
                                                   const ObservationSet& observations);

}  // namespace shoal::launch
