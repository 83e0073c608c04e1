// SPDX-License-Identifier: Apache-2.0
// Algorithms that learn from sequences of steps (AlgorithmKind::horizon): the number of steps of a
// sample, and the keys that such algorithms accept.
#pragma once

#include <string>

#include "common/config/config.h"

namespace shoal {

// Steps of the sequence in each sample of a batch; 0 if the algorithm learns without sequences.
int HorizonOf(const Config& config);
// Steps that must be stored before a sample can be drawn, unless one of them ends the task.
int SampleStepsOf(const Config& config);

// The steps of a sample for messages: "replay.n_step = 3", or "sequences of 5 steps".
std::string SampleStepsText(const Config& config);

// Throws Error (kUsage) that names the first key without effect, or network.state_hidden if the
// algorithm has no latent state.
void ValidateSequences(const Config& config);

}  // namespace shoal
