// SPDX-License-Identifier: Apache-2.0
// A safetensors file of others under our names: what `shoal train --init-from` starts networks
// from.
//
// A name map is a JSON object from our names to those of the file: a string, or a list of strings,
// whose tensors are put together along their first dimension:
//
//   {"actor.mlp.layer0.weight": "actor.latent_pi.0.weight",
//    "actor.mlp.output.weight": ["actor.mu.weight", "actor.log_std.weight"]}
#pragma once

#include <string>

#include "common/nn/safetensors.h"

namespace shoal::nn {

// The file's tensors; with a map (not empty) those that it names, by our names. Throws Error
// (usage) naming the file and what does not fit: a tensor that is missing, tensors that do not go
// together.
TensorMap ReadNamedWeights(const std::string& file, const std::string& map_file);

}  // namespace shoal::nn
