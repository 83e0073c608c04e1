// SPDX-License-Identifier: Apache-2.0
// One environment and the state of its running episode: the policy's next input and the episode's
// statistics (EpisodeFigures). The input consists of a vector and of pictures: the frame stack,
// then the goal picture if there is one. Rollouts and evaluations consist of episode runners.
//
// I: channels of the policy's input: K*C of the stack, plus C of the goal picture if there is one.
// V: numbers of the policy's vector. A: components of an action.
//
//   Begin: reset -> stack, vector -> statistics     Step: step -> stack, vector -> statistics
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "actor/acting/episode_log.h"
#include "actor/worlds/environment.h"
#include "common/spec/frame_stack.h"

namespace shoal::actor {

// Receives the observations and actions of an episode runner's policy, for example for films. Spans
// are valid during the call.
class EpisodeListener {
 public:
  struct SeenStep {
    std::span<const uint8_t> stack;  // (I, H, W): the policy's next input, after the step
    std::span<const float> action;   // (A)
    float reward = 0;                // unscaled
    bool success = false;            // false for tasks without success
    bool ended = false;              // the step was the episode's last
  };

  virtual ~EpisodeListener() = default;
  // Called when the episode of `stream_key` begins. stack (I, H, W): the policy's first input.
  virtual void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) = 0;
  virtual void OnStep(const SeenStep& step) = 0;
  // Called after a faulty step. The episode ends at the last finite observation; stack (I, H, W):
  // the policy's input for this observation.
  virtual void OnFault(std::span<const uint8_t> stack) = 0;
};

// Owns the environment, borrows the policy's input. One thread.
class EpisodeRunner {
 public:
  // Memory from which the policy reads its observation.
  struct PolicyInput {
    std::span<uint8_t> stack;  // (I, H, W); empty without pixels
    std::span<float> vector;   // (V)
  };

  // CHECK: the input has the sizes of the environment's spec.
  EpisodeRunner(std::unique_ptr<worlds::Environment> environment, PolicyInput input);

  // Starts the episode of a stream key. Writes the observation with every block to `out`, and the
  // part that the policy sees to the policy's input. If the episode still runs after `cut_after`
  // env steps, the episode is truncated as by a time limit; 0 = the environment ends the episode.
  // Returns the distance from achieved to desired goal at the start (m; NaN without goals). Throws
  // the errors of Environment::Reset; no episode runs after an error.
  float Begin(uint64_t stream_key, worlds::ObservationOut out, int cut_after = 0);
  // Plays one env step of the running episode; the step may end the episode. If the step is faulty,
  // throws EpisodeFault: the episode has ended, truncated and without success, at the last finite
  // observation. The faulty step does not count, and `out` and the policy's input are unchanged.
  worlds::StepResult Step(std::span<const float> action, worlds::ObservationOut out);
  // The `cut_after` of the running or last episode; 0 = the episode is not cut short.
  int cut_after() const { return cut_after_; }
  // Ends a running episode without a result.
  void Abandon() { running_ = false; }

  bool running() const { return running_; }
  // Statistics of the running or last episode; complete after the episode's end.
  const EpisodeFigures& figures() const { return figures_; }
  const worlds::Environment& environment() const { return *environment_; }

  // Sets the listener of every later Begin and Step. The listener is borrowed until it is replaced;
  // nullptr = none.
  void set_listener(EpisodeListener* listener) { listener_ = listener; }

 private:
  void AddToFigures(std::span<const float> action, const worlds::StepResult& result);
  void EndFaulty();
  // Computes the statistics from the episode's sums.
  void CompleteFigures();

  std::unique_ptr<worlds::Environment> environment_;
  PolicyInput input_;
  BlockPicker observed_;
  FrameStack stack_;  // the first K*C channels of the input
  EpisodeFigures figures_;
  std::vector<float> last_action_;  // empty before the episode's first action
  float distance_ = 0;              // of achieved to desired goal, at the last observation
  int cut_after_ = 0;
  bool running_ = false;
  EpisodeListener* listener_ = nullptr;
};

}  // namespace shoal::actor
