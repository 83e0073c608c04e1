// SPDX-License-Identifier: Apache-2.0
// Says when the run has reached an evaluation point, a multiple of eval.interval env steps, and
// hands the evaluation actor the F32 parameters of the checkpoint made there.
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
  // `env_steps`: stored when a former learner of the run stopped; points up to there are behind.
  EvaluationPoints(const RunConfig& run, uint64_t session, uint64_t env_steps, const Agent& agent,
                   LearnerSink& sink);

  // True once per multiple of the interval that `env_steps` has come to or passed since the last
  // call; several passed at once are one point.
  bool Reached(uint64_t env_steps);

  // Replaces eval.interval; the next point is its first multiple beyond `env_steps`.
  void SetInterval(uint64_t interval, uint64_t env_steps);
  uint64_t interval() const { return interval_; }

  // Hands out the agent's parameters, which are those of `checkpoint`. What the transport does not
  // take at once is sent by Retry; a newer point takes the place of an unsent one.
  void Send(const std::string& checkpoint, uint64_t env_steps);
  void Retry();

  // Updates of the point handed out last; 0 = none yet.
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
