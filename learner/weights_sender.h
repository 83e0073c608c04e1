// SPDX-License-Identifier: Apache-2.0
// Sends the policy's parameters to the actors: at the first update, then every
// learner.weights_period; in lockstep at the end of each phase; on policy after each update. BF16
// if the precision is bf16, else F32. On policy always F32: the actors' log-probabilities are the
// denominator of the ratio that the learner forms with its unrounded parameters (Eq. 24).
//
// Weights that are due while readers still lack the last ones wait for them, at most kPatience, so
// that slow readers are not starved; not in lockstep or on policy, where actors wait for exactly
// these.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "common/base/clock.h"
#include "common/config/run_config.h"
#include "common/nn/precision.h"
#include "learner/agent/agent.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

// Borrows agent and sink. One thread.
class WeightsSender {
 public:
  WeightsSender(const RunConfig& run, nn::Precision precision, uint64_t session, const Agent& agent,
                LearnerSink& sink);

  // Call after each update: sends when it is time.
  void AfterUpdate(uint64_t env_steps);
  // Sends at once: after a restart, so that actors need not wait.
  void Send(uint64_t env_steps);

  // Sends again what the transport did not take: where actors wait for exactly that.
  void Retry(uint64_t env_steps) {
    if (due_) Send(env_steps);
  }

  // Replaces learner.weights_period. Not for lockstep.
  void SetPeriod(uint64_t updates) { period_ = updates; }
  uint64_t period() const { return period_; }

  uint64_t sent() const { return sent_; }
  // Tries that the transport did not take; newer weights follow.
  uint64_t unsent() const { return unsent_; }

  static constexpr std::chrono::milliseconds kPatience{500};

 private:
  // Weights are copied three times: out of the agent, into these bytes, by the transport; never
  // more than two of them are there at once.
  std::string Serialised() const;
  bool Due(uint64_t updates);

  const Config config_;
  const uint64_t spec_hash_, session_;
  const bool rounds_;  // to BF16
  const Agent& agent_;
  LearnerSink& sink_;
  const bool awaited_;  // by actors that do not step meanwhile
  uint64_t period_;
  bool due_ = false;
  SteadyTime last_sent_{};
  int64_t phase_ = 0;  // lockstep: the first one whose end is not reached
  uint64_t sent_ = 0, unsent_ = 0;
};

}  // namespace shoal::learner
