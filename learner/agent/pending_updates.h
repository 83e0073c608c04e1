// SPDX-License-Identifier: Apache-2.0
// The updates of an agent whose outcomes are not known yet. Counts updates when they end, and keeps
// the sheet of each one until its engine returns the outcome.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "learner/agent/agent.h"
#include "learner/agent/figure_sheet.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

// One thread.
class PendingUpdates {
 public:
  // Borrows the engine, the sheet of the current update and the agent's count of updates.
  PendingUpdates(Engine* engine, FigureSheet* current, uint64_t* updates)
      : engine_(engine), current_(current), updates_(updates) {}

  // Ends the engine's update, empties the current sheet and counts the update. Returns the outcomes
  // that are known now. If one of them is not finite, it is the last one, and the count is that of
  // the updates before: the updates that were in flight behind it had no effect.
  std::vector<UpdateOutcome> End();
  // Waits for all updates. Returns their outcomes as End does.
  std::vector<UpdateOutcome> Finish();

 private:
  // The outcome of the oldest update.
  UpdateOutcome Take(const Engine::Outcome& outcome);

  Engine* const engine_;
  FigureSheet* const current_;
  uint64_t* const updates_;
  std::deque<FigureSheet> sheets_;  // one for each update in flight, oldest first
};

}  // namespace shoal::learner
