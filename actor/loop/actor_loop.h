// SPDX-License-Identifier: Apache-2.0
// The training actor's loop: steps its rollout at the given pace, exchanges records and credits,
// takes weights and reports. At the end it waits until all records are stored.
//
// Interfaces separate the loop from everything outside the process: records and credits (ChunkLink,
// in the sender), weights (WeightsSource), the run's state and signals (RunControl), the clock. The
// loop does not depend on DDS.
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
  // Time allowed for storing the last records. If the coordinator and the learner have died, the
  // limiter may withhold credits until the replay has also detected the coordinator's loss.
  static constexpr std::chrono::seconds kDrainDeadline =
      ControlState::kLease + std::chrono::seconds(10);
  // Longest wait for a credit while the loop has nothing else to do.
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
    kUnstored,         // the run ended or a signal came; some records were not acknowledged
    kCoordinatorLost,  // the coordinator is lost; the records may or may not be stored
  };
  // Receives the loop's state ("running", "blocked", "draining", "stopping") several times a
  // second. `last` marks the final call.
  using Progress = std::function<void(const char* state, bool last)>;

  // Runs until the run ends, a signal arrives or the coordinator is lost. Throws Error if weights
  // that the pace awaits do not arrive in time, and the errors of the parts.
  End Run(const Progress& progress);

  // Time in which no further record could be begun.
  double blocked_seconds() const { return blocked_seconds_; }
  // Time spent waiting for weights and loading them.
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
