// SPDX-License-Identifier: Apache-2.0
// Pace of an actor: decides whether the loop makes the next vector step (one step of each of its
// environments) or first waits for a weights version.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class Pace {
 public:
  enum class Turn {
    kStep,          // make a vector step
    kAwaitWeights,  // store all records and take weights as they arrive; then call Next again
    kRest,          // make no further steps; store all records and wait for the end of the run
  };

  virtual ~Pace() = default;
  // The actor's next turn. `vector_steps`: number of vector steps made since the run's start;
  // `version`: version of the actor's present weights. Call Next before every vector step.
  virtual Turn Next(int64_t vector_steps, const WeightsVersion& version) = 0;
  // True if the loop takes weights between any two steps, as soon as they arrive. False if the loop
  // takes weights only after kAwaitWeights.
  virtual bool TakesWeightsAnytime() const = 0;
  // Name of the weights for which the last kAwaitWeights waits. Used in the error if these weights
  // do not arrive.
  virtual std::string Awaited() const = 0;

  // Time that the loop waits for weights before it fails.
  virtual std::chrono::seconds patience() const { return std::chrono::seconds(120); }
  // True if running episodes end when weights of another learner process arrive: the new process
  // does not have the records of its predecessor.
  virtual bool BeginsAnewWithLearner() const { return false; }
};

// Always steps, with the newest weights.
class FreePace final : public Pace {
 public:
  Turn Next(int64_t, const WeightsVersion&) override { return Turn::kStep; }
  bool TakesWeightsAnytime() const override { return true; }
  std::string Awaited() const override { return {}; }  // awaits no weights
};

// Alternates with the learner (common/config/lockstep.h). At the end of each phase the actor waits
// for the weights of the last update of the phase; clocks have no influence. The actor rests after
// the phase that reaches the budget.
class LockstepPace final : public Pace {
 public:
  // `vector_steps`: number of vector steps in the restored state; 0 for a new actor. If the state
  // is from the middle of a phase, the phase is played with the weights of the phase before. A
  // resumed learner sends these weights first.
  LockstepPace(const Config& config, int64_t vector_steps);

  Turn Next(int64_t vector_steps, const WeightsVersion& version) override;
  bool TakesWeightsAnytime() const override { return false; }
  std::string Awaited() const override;
  int64_t phase() const { return phase_; }

 private:
  const Config config_;
  int64_t phase_ = 0;    // the phase that is being played
  uint64_t update_ = 0;  // lowest update of the weights that play the phase
};

// The pace of on-policy learning, where each rollout gives one update. Plays each rollout of
// `vector_steps` with one version of the weights. Before the next rollout the actor waits for the
// next version; if `ahead` = 1, the version before the next version is enough. Versions also show
// the progress of a learner that was restarted, or that continued without this actor.
class VersionPace final : public Pace {
 public:
  explicit VersionPace(int64_t vector_steps, int ahead = 0);

  Turn Next(int64_t vector_steps, const WeightsVersion& version) override;
  bool TakesWeightsAnytime() const override { return false; }
  std::string Awaited() const override;
  // One update of a whole rollout may take minutes.
  std::chrono::seconds patience() const override { return std::chrono::seconds(600); }
  bool BeginsAnewWithLearner() const override { return true; }

 private:
  const int64_t length_;
  const uint64_t ahead_;
  int64_t end_ = 0;           // of the running rollout, in vector steps
  uint64_t session_ = 0;      // of the learner that sent the weights of the running rollout
  uint64_t next_update_ = 0;  // of the weights that will play the next rollout
};

// Makes the pace that the configuration selects. `vector_steps`: number of vector steps that the
// actor has already made.
std::unique_ptr<Pace> MakePace(const Config& config, int64_t vector_steps);

}  // namespace shoal::actor
