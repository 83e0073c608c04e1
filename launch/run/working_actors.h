// SPDX-License-Identifier: Apache-2.0
// Decides whether a run can continue with the expendable processes that work, and describes those
// that do not work (docs/failures.md). Pure: the caller supplies RoleStanding and times.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "common/base/clock.h"
#include "common/base/liveness_timer.h"
#include "launch/processes/supervisor.h"

namespace shoal::launch {

// The training actors of a run. Look several times a second (liveness_timer.h).
class WorkingActors {
 public:
  explicit WorkingActors(SteadyTime start) : without_(start) {}

  // Returns the reason why the run must end; nothing while the run can continue. The run must end
  // - as soon as restarts of all actors seem useless and no actor has ever worked: the
  //   configuration is wrong;
  // - when no actor has worked for `patience`.
  std::optional<std::string> Look(const RoleStanding& actors, std::chrono::seconds patience,
                                  SteadyTime now);

 private:
  bool ever_ = false;      // an actor has worked
  LivenessTimer without_;  // time without a working actor
};

// If restarts of the evaluation actor seem useless, and this actor has not delivered an evaluation
// since the run was started or resumed, returns the reason why the run must end. Returns nothing
// while the run can continue.
std::optional<std::string> MissingEvaluations(const RoleStanding& evaluation, bool delivered);

// One line with the actors that do not work, and the reasons: "actors 1 of 2: actor-1: exit code 1:
// no way to host ... (death 8, next try in 25 s)". Empty if all actors work.
std::string DescribeTrouble(const RoleStanding& actors, const RoleStanding& evaluation);

}  // namespace shoal::launch
