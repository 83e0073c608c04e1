// SPDX-License-Identifier: Apache-2.0
// A checkpoint's policy as values: its observation, its network and its parameters. Acting
// (trained_policy.h) and the export to other formats use these values.
#pragma once

#include <filesystem>

#include "common/checkpoint/checkpoint_files.h"
#include "common/nn/safetensors.h"
#include "common/policy/policy_description.h"

namespace shoal::policy {

struct CheckpointPolicy {
  PolicyDescription description;
  // F32: the parameters of description.Encoder() and description.Actor() and, where vectors are
  // normalised, nn::kObservationMean and nn::kObservationVariance.
  nn::TensorMap tensors;
  CheckpointState state;
};

// Reads the checkpoint in `folder`, which may be anywhere. learner.safetensors is not read and need
// not exist. Throws Error, in one line with the file and the expectation, for missing, damaged or
// altered files, another or a newer version, or a network that this program does not support.
//
// Old versions wrote no policy.json. Their checkpoints are read only within their run's folder
// (RUN/checkpoints/NAME or RUN/checkpoints/candidates/NAME), because config.json of the run has the
// missing values.
CheckpointPolicy ReadCheckpointPolicy(const std::filesystem::path& folder);

}  // namespace shoal::policy
