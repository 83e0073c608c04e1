// SPDX-License-Identifier: Apache-2.0
// Reads a safetensors file of another program under Shoal's names, for `shoal train --init-from`.
//
// A name map is a JSON object from Shoal's names to names in the file. A value is a string, or a
// list of strings whose tensors are concatenated along their first dimension:
//
//   {"actor.mlp.layer0.weight": "actor.latent_pi.0.weight",
//    "actor.mlp.output.weight": ["actor.mu.weight", "actor.log_std.weight"]}
#pragma once

#include <string>

#include "common/nn/safetensors.h"

namespace shoal::nn {

// Returns the file's tensors. If `map_file` is not empty, returns only the tensors in the map,
// under Shoal's names. Throws Error (kUsage) that names the file and the fault: a tensor is
// missing, or tensors cannot be concatenated.
TensorMap ReadNamedWeights(const std::string& file, const std::string& map_file);

}  // namespace shoal::nn
