// SPDX-License-Identifier: Apache-2.0
// Who wrote a checkpoint, against what a run is configured with: training goes on with the
// algorithm and the network of the checkpoint alone. Refusals name both sides.
#pragma once

#include <filesystem>
#include <string>

#include "common/checkpoint/checkpoint_files.h"
#include "common/config/config.h"

namespace shoal::policy {

// The keys network.* in which two networks differ, for messages:
//   network.encoder = "compact" there, "drq" here; network.hidden = [256,256] there, [64] here
// Empty where none does. network.encoder_weights, which training starts from, is not compared.
std::string NetworkDifference(const NetworkConfig& there, const NetworkConfig& here);

// The same between `here` and the network of the checkpoint to which a file of weights belongs.
// Empty also where no policy.json that can be read lies beside the file.
std::string DifferenceFromWriter(const std::filesystem::path& weights, const NetworkConfig& here);

// `description`: the checkpoint's policy.json; empty, or of another version, it says nothing of the
// network, which is then left to the tensors. Throws Error (kUsage) naming the folder, and the
// algorithms or the keys of the networks that differ.
void CheckWriter(const std::filesystem::path& folder, const CheckpointState& state,
                 const std::string& description, const Config& config);

}  // namespace shoal::policy
