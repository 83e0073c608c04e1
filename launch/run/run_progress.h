// SPDX-License-Identifier: Apache-2.0
// The progress of a run, from the typed messages of replay and learner, and the list of requested
// evaluations. This progress decides budget, drain and end of the run. Reports (MetricsMessage) are
// only for display and files. Pure.
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
  // Only messages of the newest session of a replay, or of the learner, count; a late message of an
  // earlier session changes nothing. OnReplay returns whether a new replay began without its
  // predecessor's records.
  bool OnReplay(const ReplayProgress& progress);
  void OnLearner(const LearnerProgress& progress);
  // Call when the learner has died. In a run without a replay, the next learner continues from a
  // checkpoint with fewer env steps.
  void OnLearnerDeath() { died_ = learner_.session; }

  // Number of stored steps: the sum over all replays; in a run without a replay, the learner's
  // count. 0 before the first report. The number never falls, although a replay that lost its
  // memory may report fewer steps than its predecessor (about one second of steps).
  uint64_t stored_steps() const;
  std::optional<uint64_t> updates() const;
  // Whether the learner that reported last is alive.
  bool learner_lives() const { return learner_.session > died_; }
  // Whether the learner has made all updates that the stored steps allow.
  bool drained() const { return learner_.drained; }
  // Update count of the parameters that the learner last sent for evaluation; 0 = none yet.
  uint64_t evaluation_due() const;
  // Whether the learner has sent the parameters of this evaluation for evaluation.
  bool AskedFor(const EvaluationPoint& point) const;

 private:
  std::map<uint32_t, ReplayProgress> replays_;
  uint64_t env_steps_ = 0;  // largest sum over `replays_`
  LearnerProgress learner_;
  uint64_t died_ = 0;  // newest session of a learner that died
  // Requested evaluations of all sessions, keyed by learner session and update.
  std::map<std::pair<uint64_t, uint64_t>, EvaluationRequest> asked_;
};

}  // namespace shoal::launch
