// SPDX-License-Identifier: Apache-2.0
// Contents of a checkpoint's policy: the observation, the network and the parameters. Acting
// (trained_policy.h) and the export to other formats use these contents.
#pragma once

#include <filesystem>

#include "common/checkpoint/checkpoint_files.h"
#include "common/nn/safetensors.h"
#include "common/policy/policy_description.h"

namespace shoal::policy {

struct CheckpointPolicy {
  PolicyDescription description;
  // F32 tensors: the parameters of description.Encoder() and description.Actor() and, if vectors
  // are normalised, nn::kObservationMean and nn::kObservationVariance.
  nn::TensorMap tensors;
  CheckpointState state;
};

// Reads the checkpoint in `folder`, which need not be in a run's folder. learner.safetensors is not
// read and need not exist. Throws Error, in one line with the file and the expectation, if a file
// is missing, damaged or altered, has an unknown version, or describes a network that this program
// does not support.
//
// Old versions wrote no policy.json. A checkpoint of an old version is read only within its run's
// folder (RUN/checkpoints/NAME or RUN/checkpoints/candidates/NAME), because the run's config.json
// has the missing values.
CheckpointPolicy ReadCheckpointPolicy(const std::filesystem::path& folder);

}  // namespace shoal::policy
