// SPDX-License-Identifier: Apache-2.0
// One environment and what belongs to the episode it plays: the pictures (the frame stack, then the
// goal picture where the policy sees one) and the vector that the policy reads next, the episode's
// figures, whether it still runs. Rollouts and evaluations are made of episode runners.
//
//   Begin: reset -> stack, vector -> figures        Step: step -> stack, vector -> figures
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "actor/acting/episode_log.h"
#include "actor/worlds/environment.h"
#include "common/spec/frame_stack.h"

namespace shoal::actor {

// Receives the observations and actions of an episode runner's policy, for films and the like.
// Spans are valid during the call.
class EpisodeListener {
 public:
  struct SeenStep {
    std::span<const uint8_t> stack;  // (I, H, W): the policy's next input, after the step
    std::span<const float> action;   // (A)
    float reward = 0;                // unscaled
    bool success = false;            // false where the task has none
    bool ended = false;              // the step was the episode's last
  };

  virtual ~EpisodeListener() = default;
  // The episode's stream key; stack (I, H, W): the policy's first input of the episode.
  virtual void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) = 0;
  virtual void OnStep(const SeenStep& step) = 0;
  // The episode ended at its last step, or at its beginning: the step after that was faulty. The
  // stack is still that of then.
  virtual void OnFault(std::span<const uint8_t> stack) = 0;
};

// Owns the environment, borrows the policy's input. One thread.
class EpisodeRunner {
 public:
  // Memory from which the policy reads its observation: (I, H, W) u8, empty without pixels; (V)
  // f32.
  struct PolicyInput {
    std::span<uint8_t> stack;
    std::span<float> vector;
  };

  // CHECK on an input of other sizes than the environment's spec says.
  EpisodeRunner(std::unique_ptr<worlds::Environment> environment, PolicyInput input);

  // Starts the episode of a stream key; the observation is written to `out`, with every block, and
  // what the policy sees of it into the policy's input. After `cut_after` env steps it is
  // truncated, as by a time limit, if it still runs; 0 = its environment ends it. Returns the
  // distance at the start. Errors: as of Environment; no episode runs then.
  float Begin(uint64_t stream_key, worlds::ObservationOut out, int cut_after = 0);
  // One env step of the running episode, which it may end. Throws EpisodeFault: the episode has
  // ended, truncated and without success, at the observation before; the step does not count, and
  // neither `out` nor the policy's input was changed.
  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out);
  // Argument of Begin for the episode that runs or has just ended; 0 = it is whole.
  int cut_after() const { return cut_after_; }
  // Forgets a running episode.
  void Abandon() { running_ = false; }

  bool running() const { return running_; }
  // Figures of the running episode, or of the last one; complete once that has ended.
  const EpisodeFigures& figures() const { return figures_; }
  const worlds::Environment& environment() const { return *environment_; }

  // Called for every Begin and Step from now on. Borrowed until it is replaced; nullptr = none.
  void set_listener(EpisodeListener* listener) { listener_ = listener; }

 private:
  void AddToFigures(std::span<const float> action, const worlds::StepResult& result);
  void EndFaulty();
  // Turns the sums of the episode into its figures.
  void CompleteFigures();

  std::unique_ptr<worlds::Environment> environment_;
  PolicyInput input_;
  BlockPicker observed_;
  FrameStack stack_;  // the first K*C channels of the input
  EpisodeFigures figures_;
  std::vector<float> last_action_;  // empty before the episode's first
  float distance_ = 0;              // after the last observation
  int cut_after_ = 0;
  bool running_ = false;
  EpisodeListener* listener_ = nullptr;
};

}  // namespace shoal::actor
