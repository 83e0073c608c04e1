// SPDX-License-Identifier: Apache-2.0
// Observations that two computations of one policy are compared on.
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

// Images of noise, each of a range of brightness of its own. Vectors normal around 0 with deviation
// 1; where the policy normalises them (`scale`) around what it is used to, a tenth of their numbers
// 30 times as far away: what is cut off is seen.
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
