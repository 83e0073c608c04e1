// SPDX-License-Identifier: Apache-2.0
// The selector and the relabeller that a configuration selects. A new selector or relabeller needs
// a file of its own, its configuration keys, and a line here.
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
  std::unique_ptr<GoalChange> goals;       // not null if there is a relabeller
  std::unique_ptr<Selector> selector;      // may borrow goals
};

// The policies borrow ring and index. Throws Error like CheckHindsight.
ReplayPolicies MakePolicies(const RunConfig& run, const Ring& ring, const EpisodeIndex& index);

IndexOptions IndexOptionsOf(const RunConfig& run);

// Upper bound of the number of stored steps of an actor session that wait for a later record. A
// step waits for the n - 1 steps after it, or for the end of its episode.
uint64_t WaitingSteps(const RunConfig& run);

}  // namespace shoal::replay
