// SPDX-License-Identifier: Apache-2.0
// A checkpoint's policy as values: what it observes, its network and its parameters. For acting
// (trained_policy.h) and for export to other formats.
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

// `folder`: a checkpoint, wherever it lies. learner.safetensors is not read and need not be there.
// Throws Error in one line naming the file and what was expected: missing, damaged or altered
// files, another or a newer version, a network that this program does not have.
//
// Checkpoints of versions that wrote no policy.json are read in their run's folder
// (RUN/checkpoints/NAME or RUN/checkpoints/candidates/NAME), whose config.json says what is
// missing; elsewhere they are refused.
CheckpointPolicy ReadCheckpointPolicy(const std::filesystem::path& folder);

}  // namespace shoal::policy
