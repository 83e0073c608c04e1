// SPDX-License-Identifier: Apache-2.0
// Compares the algorithm and the network of a checkpoint with the configuration of a run. Training
// can continue from a checkpoint only if both are equal. Error messages name both sides.
#pragma once

#include <filesystem>
#include <string>

#include "common/checkpoint/checkpoint_files.h"
#include "common/config/config.h"

namespace shoal::policy {

// The keys network.* by which two networks differ, for messages:
//   network.encoder = "compact" there, "drq" here; network.hidden = [256,256] there, [64] here
// Empty if the networks are equal. network.encoder_weights is not compared, because it only sets
// the initial weights.
std::string NetworkDifference(const NetworkConfig& there, const NetworkConfig& here);

// The difference between `here` and the network of the checkpoint that contains the file `weights`.
// Also empty if the folder of `weights` has no policy.json that this program can read.
std::string DifferenceFromWriter(const std::filesystem::path& weights, const NetworkConfig& here);

// Throws Error (kUsage) if the algorithms or the networks differ, naming the folder and both
// algorithms or the keys that differ. `description` is the checkpoint's policy.json. If it is empty
// or of another version, networks are not compared here, and the check of the tensors must find a
// difference.
void CheckWriter(const std::filesystem::path& folder, const CheckpointState& state,
                 const std::string& description, const Config& config);

}  // namespace shoal::policy
