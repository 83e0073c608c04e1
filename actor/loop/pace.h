// SPDX-License-Identifier: Apache-2.0
// When an actor may step: the turns that its loop takes between vector steps (one step of each of
// its environments) and weights versions.
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
    kStep,          // step
    kAwaitWeights,  // have everything stored and take weights as they come; then ask again
    kRest,          // step no more: have everything stored until the run ends
  };

  virtual ~Pace() = default;
  // What to do after `vector_steps` of the actor since the run's start, while it acts by `version`.
  // To be asked before every vector step.
  virtual Turn Next(int64_t vector_steps, const WeightsVersion& version) = 0;
  // Whether weights are taken between steps as they come, too, and not only when awaited.
  virtual bool TakesWeightsAnytime() const = 0;
  // The weights that the last kAwaitWeights is about, for the error when they do not come.
  virtual std::string Awaited() const = 0;

  // For how long weights are awaited before that is an error.
  virtual std::chrono::seconds patience() const { return std::chrono::seconds(120); }
  // Whether episodes end where they are when another learner's weights are taken: it has forgotten
  // what came before.
  virtual bool BeginsAnewWithLearner() const { return false; }
};

// Steps always, by the newest weights there are.
class FreePace final : public Pace {
 public:
  Turn Next(int64_t, const WeightsVersion&) override { return Turn::kStep; }
  bool TakesWeightsAnytime() const override { return true; }
  std::string Awaited() const override { return {}; }  // it awaits none
};

// Takes turns with the learner (common/config/lockstep.h): at the end of each phase it awaits the
// weights of that phase's last update, whatever the clocks say; it rests from the phase on in which
// the budget is reached.
class LockstepPace final : public Pace {
 public:
  // `vector_steps`: done when the actor goes on from a former process's state, else 0. Half-way
  // through a phase the former one acted by the weights of the phase before, which the learner
  // offers first when it resumes.
  LockstepPace(const Config& config, int64_t vector_steps);

  Turn Next(int64_t vector_steps, const WeightsVersion& version) override;
  bool TakesWeightsAnytime() const override { return false; }
  std::string Awaited() const override;
  int64_t phase() const { return phase_; }

 private:
  const Config config_;
  int64_t phase_ = 0;    // the one that is being played
  uint64_t update_ = 0;  // of the weights that the phase is played by, at least
};

// Plays rollouts of `vector_steps` each by one version of the weights, and awaits the one that
// follows before the next, or, `ahead` = 1, the one before that: the pace of on-policy learning,
// where each rollout makes one update. A learner that was restarted, or went on without this actor,
// says by its version where it is.
class VersionPace final : public Pace {
 public:
  explicit VersionPace(int64_t vector_steps, int ahead = 0);

  Turn Next(int64_t vector_steps, const WeightsVersion& version) override;
  bool TakesWeightsAnytime() const override { return false; }
  std::string Awaited() const override;
  // An update takes as long as it takes.
  std::chrono::seconds patience() const override { return std::chrono::seconds(600); }
  bool BeginsAnewWithLearner() const override { return true; }

 private:
  const int64_t length_;
  const uint64_t ahead_;
  int64_t end_ = 0;           // of the running rollout, in vector steps
  uint64_t session_ = 0;      // of the learner whose weights it is played by
  uint64_t next_update_ = 0;  // of the weights that the next rollout is to be played by
};

// The pace that a run's configuration asks of an actor that has done `vector_steps` before.
std::unique_ptr<Pace> MakePace(const Config& config, int64_t vector_steps);

}  // namespace shoal::actor
