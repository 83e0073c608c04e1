// SPDX-License-Identifier: Apache-2.0
// Decides when a run's evaluations have reached a success rate. The stop rule, first_success in
// meta.json, n_to_target of experiments and the env steps to a target in `compare` all use this
// rule. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace shoal::launch {

// The success rate of one evaluation.
struct EvaluatedSuccess {
  std::optional<double> rate{};  // 0..1; empty if the task has no success: never reached
  size_t episodes = 0;
};

// Whether the pooled episodes of all these evaluations have a success rate of at least `target`.
// False without episodes.
bool ReachTogether(std::span<const EvaluatedSuccess> evaluations, double target);

// Finds the first `in_a_row` (at least 1) consecutive evaluations that reach `target` together.
// Returns the index of the first of these evaluations; empty = not reached.
std::optional<size_t> FirstReached(std::span<const EvaluatedSuccess> evaluations, double target,
                                   size_t in_a_row);

}  // namespace shoal::launch
