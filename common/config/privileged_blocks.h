// SPDX-License-Identifier: Apache-2.0
// Privileged inputs: blocks of the record that learning uses and that are no part of the policy's
// observation.
//
//   sac.critic_blocks   an asymmetric critic sees them in place of the pixels (Eq. 26 of
//                           docs/algorithm.md)
//   sac.aux             labels of the auxiliary loss (Eq. 27)
//
// Source: Pinto et al. 2018, "Asymmetric actor critic for image-based robot learning",
// arXiv:1710.06542.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal {

// A label of the auxiliary loss: a block, or the difference of two of equal size.
struct AuxLabel {
  std::string block;
  std::string minus;  // empty: nothing is taken off
  int size = 0;
};

struct PrivilegedBlocks {
  std::vector<std::string> critic;  // of sac.critic_blocks, those the policy does not see
  std::vector<AuxLabel> labels;     // of sac.aux
  // Both together, in record order, each once: what batches carry (BatchOptions::privileged).
  std::vector<std::string> all;
};

// Throws Error (kUsage) naming the key, the block that the record does not have or that does not
// fit, and the blocks there are; of critic blocks also where the policy observes all that are
// named.
PrivilegedBlocks PrivilegedBlocksOf(const Config& config, const ObservationSpec& spec);
// P, of all of them. Throws the same.
int PrivilegedSize(const Config& config, const ObservationSpec& spec);

}  // namespace shoal
