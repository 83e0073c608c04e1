// SPDX-License-Identifier: Apache-2.0
// Detects evaluation points, which are multiples of eval.interval env steps, and sends the F32
// parameters of the checkpoint made there to the evaluation actor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/run_config.h"
#include "common/wire/messages.h"
#include "learner/agent/agent.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

// Borrows agent and sink. One thread.
class EvaluationPoints {
 public:
  // `env_steps`: env steps stored when the previous learner of the run stopped; points up to this
  // number are already done.
  EvaluationPoints(const RunConfig& run, uint64_t session, uint64_t env_steps, const Agent& agent,
                   LearnerSink& sink);

  // Returns true if `env_steps` has reached or passed a multiple of the interval since the last
  // call. Several multiples passed at once count as one point.
  bool Reached(uint64_t env_steps);

  // Replaces eval.interval; the next point is its first multiple beyond `env_steps`.
  void SetInterval(uint64_t interval, uint64_t env_steps);
  uint64_t interval() const { return interval_; }

  // Sends the agent's parameters, which must be those of `checkpoint`. If the transport does not
  // accept them, Retry sends them later; a newer point replaces an unsent one.
  void Send(const std::string& checkpoint, uint64_t env_steps);
  void Retry();

  // Updates of the point sent last; 0 = none yet.
  uint64_t last_updates() const { return last_updates_; }
  uint64_t overtaken() const { return overtaken_; }

 private:
  const uint64_t spec_hash_, session_;
  uint64_t interval_;  // env steps
  const Agent& agent_;
  LearnerSink& sink_;
  uint64_t next_;  // env steps
  struct Unsent {
    EvalWeightsMessage message;  // its payload is `bytes`
    std::string bytes;
  };
  std::optional<Unsent> unsent_;
  uint64_t last_updates_ = 0, overtaken_ = 0;
};

}  // namespace shoal::learner
