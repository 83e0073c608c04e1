// SPDX-License-Identifier: Apache-2.0
// The training actor's loop: steps its rollout at the pace it is given, exchanges records and
// credits, takes weights, reports; and at the end has everything stored.
//
// Everything outside the process is behind a seam: records and credits (ChunkLink, in the sender),
// weights (WeightsSource), the run's state and signals (RunControl), the clock. No DDS here.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "actor/acting/action_selector.h"
#include "actor/acting/weights_inbox.h"
#include "actor/loop/pace.h"
#include "actor/loop/rollout.h"
#include "actor/loop/run_control.h"
#include "actor/sending/chunk_sender.h"
#include "common/wire/control_state.h"

namespace shoal::actor {

// Borrows its parts. One thread.
class ActorLoop {
 public:
  // For the last records to be stored. When the coordinator and with it the learner is gone, the
  // limiter may hold them back until the replay has noticed, too.
  static constexpr std::chrono::seconds kDrainDeadline =
      ControlState::kLease + std::chrono::seconds(10);
  // Per look for a credit while there is nothing else to do.
  static constexpr std::chrono::milliseconds kBlockedWait{5};

  struct Parts {
    Rollout& rollout;
    ActionSelector& selector;
    ChunkSender& sender;
    WeightsSource& weights;
    Pace& pace;
    RunControl& control;
    std::function<SteadyTime()> now = Now;
  };
  explicit ActorLoop(const Parts& parts) : parts_(parts) {}

  enum class End {
    kAllStored,        // the run ended or a signal came; every record made is stored
    kUnstored,         // the same, but records are left that were not reported stored
    kCoordinatorLost,  // whatever became of the records
  };
  // Told of the loop's state ("running", "blocked", "draining", "stopping") several times a second;
  // `last` is the final time.
  using Progress = std::function<void(const char* state, bool last)>;

  // Until the run ends, a signal comes or the coordinator is lost. Throws Error when weights that
  // the pace awaits do not come in time, or as the parts do.
  End Run(const Progress& progress);

  // Spent without room for records; spent awaiting and loading weights.
  double blocked_seconds() const { return blocked_seconds_; }
  double weights_seconds() const { return weights_seconds_; }

 private:
  const char* Advance();
  void AwaitWeights();
  void TakeWeights();
  void AwaitCredit();
  bool Drain(const Progress& progress);

  const Parts parts_;
  std::optional<SteadyTime> awaiting_until_;
  double blocked_seconds_ = 0, weights_seconds_ = 0;
};

}  // namespace shoal::actor
