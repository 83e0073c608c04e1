// SPDX-License-Identifier: Apache-2.0
// Which samples a batch consists of and with which goals, as the configuration has it. A new way of
// selecting or relabelling is a file of its own, its keys, and a line here.
#pragma once

#include <cstdint>
#include <memory>

#include "common/config/run_config.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/goal_change.h"
#include "replay_server/core/relabeller.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"

namespace shoal::replay {

struct ReplayPolicies {
  std::unique_ptr<Relabeller> relabeller;  // null: every sample keeps its goal
  std::unique_ptr<GoalChange> goals;       // there with a relabeller
  std::unique_ptr<Selector> selector;      // may borrow goals
};

// They borrow ring and index. Throws Error as CheckHindsight.
ReplayPolicies MakePolicies(const RunConfig& run, const Ring& ring, const EpisodeIndex& index);

IndexOptions IndexOptionsOf(const RunConfig& run);

// Stored steps per actor session that may become sampleable with a later record: those that wait
// for the n - 1 after them, or for their episode's end.
uint64_t WaitingSteps(const RunConfig& run);

}  // namespace shoal::replay
