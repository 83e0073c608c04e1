// SPDX-License-Identifier: Apache-2.0
// Decides whether a run can continue with its working expendable processes, and describes the
// others (docs/failures.md). Pure: the caller supplies standings and times.
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

  // Returns why the run must end, or nothing while the run can continue. The run must end
  // - as soon as restarts of all actors seem to be in vain, unless one worked before: the
  //   configuration is wrong;
  // - when no actor has worked for `patience`.
  std::optional<std::string> Look(const RoleStanding& actors, std::chrono::seconds patience,
                                  SteadyTime now);

 private:
  bool ever_ = false;      // an actor has worked
  LivenessTimer without_;  // time without a working actor
};

// Returns why a run must end if its evaluation actor has not delivered an evaluation since the
// start or resumption, and restarts seem to be in vain. Returns nothing while the run can continue.
std::optional<std::string> MissingEvaluations(const RoleStanding& evaluation, bool delivered);

// One line that says which actors do not work and why: "actors 1 of 2: actor-1: exit code 1: no way
// to host ... (death 8, next try in 25 s)". Empty when all work.
std::string DescribeTrouble(const RoleStanding& actors, const RoleStanding& evaluation);

}  // namespace shoal::launch
