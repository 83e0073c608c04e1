// SPDX-License-Identifier: Apache-2.0
// metadata.json of a Minari dataset, in the folder of the HDF5 file with the episodes.
//
// Source: Minari 0.5.4, https://minari.farama.org (dataset_standards). The file has the members
// that minari.MinariDataset reads. Spaces are Gymnasium spaces, as JSON text within the JSON.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/spec/observation_spec.h"

namespace shoal::launch {

inline constexpr char kMinariData[] = "main_data.hdf5";  // file name that Minari requires
inline constexpr char kMinariMetadata[] = "metadata.json";

struct MinariFacts {
  std::string run;        // name of the run; the dataset's id is shoal/RUN-v0
  std::string algorithm;  // learner.algorithm
  uint64_t episodes = 0, steps = 0;
  uint64_t bytes = 0;  // size of the HDF5 file
};

// Text of the file. Observations are a dict of every recorded block (float32, without bounds) and,
// if the spec has pixels, `pixels` (C, H, W) uint8. Actions: (A,) in [-1, 1].
std::string MinariMetadata(const ObservationSpec& spec, const MinariFacts& facts);

}  // namespace shoal::launch
