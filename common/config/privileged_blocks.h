// SPDX-License-Identifier: Apache-2.0
// Privileged inputs: blocks of the record that learning uses but the policy does not observe.
//
//   sac.critic_blocks   inputs of an asymmetric critic, in place of the pixels (Eq. 26 of
//                       docs/algorithm.md)
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

// A label of the auxiliary loss: a block, or the difference of two blocks of equal size.
struct AuxLabel {
  std::string block;
  std::string minus;  // block that is subtracted; empty = no subtraction
  int size = 0;
};

struct PrivilegedBlocks {
  std::vector<std::string> critic;  // blocks of sac.critic_blocks that the policy does not observe
  std::vector<AuxLabel> labels;     // labels of sac.aux
  // All blocks of `critic` and `labels`, in record order, without duplicates. Batches contain these
  // blocks (BatchOptions::privileged).
  std::vector<std::string> all;
};

// The privileged inputs of a run. Throws Error (kUsage) if the record lacks a block or a block does
// not fit; the error names the key, the block and the existing blocks. Also throws if the policy
// observes all named critic blocks.
PrivilegedBlocks PrivilegedBlocksOf(const Config& config, const ObservationSpec& spec);
// P: number of floats of all privileged blocks. Throws the same errors as PrivilegedBlocksOf.
int PrivilegedSize(const Config& config, const ObservationSpec& spec);

}  // namespace shoal
