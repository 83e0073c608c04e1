// SPDX-License-Identifier: Apache-2.0
// How far a run is, by the typed word of replay and learner: what its budget, its draining and its
// end are decided by, and which evaluations it has asked for. Reports (MetricsMessage) are shown
// and filed, and decide nothing. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/wire/messages.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

class RunProgress {
 public:
  // The newest session of each replay, and of the learner, has the word; a late one of a process
  // that is gone changes nothing. Of a replay: whether it began without what its predecessor held.
  bool OnReplay(const ReplayProgress& progress);
  void OnLearner(const LearnerProgress& progress);

  // Of all replays together; in a run without one, the learner's count. 0 before any has reported.
  // Never falls: a replay that lost its memory may know a second less than its predecessor said.
  uint64_t stored_steps() const;
  std::optional<uint64_t> updates() const;
  // The learner has done what the stored steps allow.
  bool drained() const { return learner_.drained; }
  // Updates of the parameters it handed out for evaluation last; 0 = none yet.
  uint64_t evaluation_due() const;
  // The learner has handed out these parameters for evaluation.
  bool AskedFor(const EvaluationPoint& point) const;

 private:
  std::map<uint32_t, ReplayProgress> replays_;
  uint64_t env_steps_ = 0;  // the most that `replays_` came to
  LearnerProgress learner_;
  // By learner session and update, over all sessions.
  std::map<std::pair<uint64_t, uint64_t>, EvaluationRequest> asked_;
};

}  // namespace shoal::launch
