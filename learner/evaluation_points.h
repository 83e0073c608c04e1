// SPDX-License-Identifier: Apache-2.0
// Detects evaluation points, which are the multiples of eval.interval env steps. At each point,
// sends the F32 parameters of the point's checkpoint to the evaluation actor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/run_config.h"
#include "common/wire/messages.h"
#include "learner/agent/agent.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

// Borrows agent and sink. Only one thread may use an object.
class EvaluationPoints {
 public:
  // `env_steps`: env steps stored when the previous learner of the run stopped. The previous
  // learner handled the points up to this number.
  EvaluationPoints(const RunConfig& run, uint64_t session, uint64_t env_steps, const Agent& agent,
                   LearnerSink& sink);

  // Returns true if `env_steps` has reached or passed a multiple of the interval since the last
  // call. If several multiples were passed since then, they count as one point.
  bool Reached(uint64_t env_steps);

  // Replaces eval.interval. The next point is the first multiple of `interval` beyond `env_steps`.
  void SetInterval(uint64_t interval, uint64_t env_steps);
  uint64_t interval() const { return interval_; }

  // Sends the agent's parameters, which must be those of `checkpoint`. If the transport does not
  // accept the parameters, Retry sends them later. If a newer point is reached before, only the
  // parameters of the newer point are sent.
  void Send(const std::string& checkpoint, uint64_t env_steps);
  void Retry();

  // Updates of the point whose parameters were sent last; 0 if none were sent yet.
  uint64_t last_updates() const { return last_updates_; }
  // Number of points whose parameters were never sent, because a newer point replaced them.
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
