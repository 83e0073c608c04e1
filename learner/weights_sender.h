// SPDX-License-Identifier: Apache-2.0
// Sends the policy's parameters to the actors: off policy after the first update, then every
// learner.weights_period updates; in lockstep at the end of each phase; on policy after each
// update. The type is BF16 if the precision is bf16, else F32. On policy the type is always F32:
// the actors' log-probabilities are the denominator of a ratio (Eq. 24), and the learner computes
// the numerator with unrounded parameters.
//
// If readers have not yet received the last weights, the next weights are delayed by at most
// kPatience, so that slow readers also receive complete weights. In lockstep and on policy there is
// no delay, because actors wait for the next weights.
//
// Weights leave an agent in two steps, so that an agent with updates in flight continues with
// further updates: Begin starts a copy, and SendCopied sends it when its last update is known to be
// finite. At most one copy is on its way.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "common/base/clock.h"
#include "common/config/run_config.h"
#include "common/nn/pending_tensors.h"
#include "common/nn/precision.h"
#include "learner/agent/agent.h"
#include "learner/learner_sink.h"

namespace shoal::learner {

// Borrows agent and sink. Only one thread may use an object.
class WeightsSender {
 public:
  WeightsSender(const RunConfig& run, nn::Precision precision, uint64_t session, const Agent& agent,
                LearnerSink& sink);

  // Call after each update. Returns whether it is time to begin, which is never while a copy is on
  // its way; weights that become due meanwhile begin after it.
  bool DueAfterUpdate();
  // Begins a copy of the weights of the update that was submitted last.
  void Begin(uint64_t env_steps);
  // Waits for the copy that was begun and sends it, if all its updates are among the first
  // `finite_updates` updates, which are known to be finite.
  void SendCopied(uint64_t finite_updates);
  // Sends at once. No update of the agent may be in flight.
  void Send(uint64_t env_steps);

  // If the transport did not accept weights for which actors wait, sends the weights again.
  void Retry(uint64_t env_steps) {
    if (due_) Send(env_steps);
  }

  // Replaces learner.weights_period. Not for lockstep.
  void SetPeriod(uint64_t updates) { period_ = updates; }
  uint64_t period() const { return period_; }

  uint64_t sent() const { return sent_; }
  // Number of attempts that the transport did not accept; newer weights follow.
  uint64_t unsent() const { return unsent_; }

  static constexpr std::chrono::milliseconds kPatience{500};

 private:
  struct Copied {
    uint64_t updates, env_steps;
    nn::PendingTensors tensors;
  };

  // Returns the weights as bytes. Weights are copied three times: from the agent, into these bytes,
  // and by the transport. At most two copies exist at the same time.
  std::string Serialised(nn::TensorMap tensors) const;
  bool Due(uint64_t updates);

  const Config config_;
  const uint64_t spec_hash_, session_;
  const bool rounds_;  // whether to round to BF16
  const Agent& agent_;
  LearnerSink& sink_;
  const bool awaited_;  // actors do not step until the weights arrive
  uint64_t period_;
  std::optional<Copied> copied_;
  bool due_ = false;
  SteadyTime last_sent_{};
  int64_t phase_ = 0;  // lockstep: the first unfinished phase
  uint64_t sent_ = 0, unsent_ = 0;
};

}  // namespace shoal::learner
