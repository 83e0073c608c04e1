// SPDX-License-Identifier: Apache-2.0
// Compares the algorithm and the network of a checkpoint with the configuration of a run. Training
// can continue from a checkpoint only if algorithm and network are the same. Error messages contain
// the values of the checkpoint and of the configuration.
#pragma once

#include <filesystem>
#include <string>

#include "common/checkpoint/checkpoint_files.h"
#include "common/config/config.h"

namespace shoal::policy {

// The keys network.* whose values differ between two networks, for messages:
//   network.encoder = "compact" there, "drq" here; network.hidden = [256,256] there, [64] here
// Empty if the networks are equal. network.encoder_weights is not compared, because it only sets
// the initial weights.
std::string NetworkDifference(const NetworkConfig& there, const NetworkConfig& here);

// The difference between `here` and the network of the checkpoint that contains the file `weights`.
// Also empty if the folder of `weights` has no policy.json that this program can read.
std::string DifferenceFromWriter(const std::filesystem::path& weights, const NetworkConfig& here);

// Throws Error (kUsage) if the algorithms or the networks differ. The error names the folder, and
// the two algorithms or the keys that differ. `description`: text of the checkpoint's policy.json.
// If this text is empty or has another version, this function does not compare the networks; a
// difference is then found only by the check of the tensors.
void CheckWriter(const std::filesystem::path& folder, const CheckpointState& state,
                 const std::string& description, const Config& config);

}  // namespace shoal::policy
