// SPDX-License-Identifier: Apache-2.0
// E environments stepped together: reset, act, step, and one record each time.
//
// Resets take longer than steps, and all environments wait for one. Where all of them begin an
// episode in the same step, as at the start, those episodes are cut short so that they end at
// different steps, and so do those that follow:
//
//   environment e of E truncates it after ceil(L (e + 1) / E) of the L env steps of a whole one.
//
// A faulty episode (actor/worlds/episode_fault.h) ends at its last finite observation. The step
// that failed is not recorded; its environment begins another episode and steps in that, so that
// every vector step still has one step record of each environment: budget, lockstep and rollouts on
// policy count as without. The replay sees the next episode begin and closes the faulty one there.
//
// Borrows everything it is built from. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "actor/acting/action_selector.h"
#include "actor/acting/episode_log.h"
#include "actor/acting/episode_runner.h"
#include "actor/acting/fault_log.h"
#include "actor/loop/rollout_state.h"
#include "actor/sending/record_sink.h"
#include "actor/sending/sequence_log.h"
#include "actor/worlds/environment.h"
#include "common/base/random.h"
#include "common/spec/record.h"

namespace shoal::actor {

// Seconds spent since the start, by stage.
struct StageSeconds {
  bool users = false;  // the environments are a user's own
  // Stages of Shoal's own worlds.
  double physics = 0;  // and all else that an environment does but rendering
  double rendering = 0;
  // Stages of environments of a user's own.
  double user_code = 0;   // their reset and step
  double conversion = 0;  // between their arrays and Shoal's, and all else
  double inference = 0;
};

class Rollout {
 public:
  struct Options {
    int64_t seed = 0;        // the run's
    uint32_t first_env = 0;  // number in the run of the first of the environments
    // This actor's share of exploration.random_steps, and all of them. Whichever of the two is
    // reached first, the one by its own env steps or the other by the run's, ends the warm-up: so
    // an actor that was restarted or joined late does not begin anew.
    uint64_t own_random_steps = 0, run_random_steps = 0;
    int episode_steps = 0;        // L
    double max_faulty_share = 0;  // FaultLog

    static Options Of(const Config& config, uint32_t first_env);
  };
  // The environments observe what `spec` says and are as many as the selector chooses for.
  Rollout(const Options& options, const ObservationSpec& spec,
          std::vector<std::unique_ptr<worlds::Environment>> environments, SequenceLog& made,
          RecordSink& sink, ActionSelector& selector);

  // Steps every environment once; begins an episode where the last one ended. Returns false, and
  // does nothing, while the sink has no room for the records. It also returns false after a faulty
  // step: the next call then continues with the environments that still owe a step. Throws Error
  // (kNonFinite) if the share of faulty episodes exceeds max_faulty_share.
  bool TryStep();

  // Ends the running episodes; the next step begins new ones. Needed when the receiver is a new
  // process, which does not have the episodes' first records.
  void AbandonEpisodes();

  // The present state. The caller fills in `session` and `made`.
  RolloutState State() const;
  // Continues from another process's state: plays the running episodes again by their actions and
  // publishes nothing. Call it before the first step. Throws Error if the state was made with other
  // environments.
  void Restore(const RolloutState& state);

  // Steps of this actor: since the run's start if its state was restored, else since its own start.
  uint64_t env_steps() const { return env_steps_; }
  int64_t vector_steps() const { return static_cast<int64_t>(env_steps_ / slots_.size()); }
  // All ended episodes except those with a cut (CutAfter). Among these only short episodes end
  // before their cut, so that counting them would bias the figures.
  const EpisodeLog& episodes() const { return episodes_; }
  const FaultLog& faults() const { return faults_; }
  StageSeconds seconds() const;

 private:
  struct Slot {
    EpisodeRunner runner;
    uint32_t episode = 0;
    std::vector<float> actions;  // of the running episode
  };

  bool WarmingUp() const;
  // Begins an episode wherever none runs and a step is owed.
  void BeginEpisodes();
  void BeginEpisode(int e, int cut_after);
  // Resets the environment for the first of its next episodes that can begin; `record` gets it.
  void ResetRunner(int e, int cut_after, uint8_t* record);
  // Env steps after which the episode is cut that begins in the same step as all others; 0 = no
  // cut.
  int CutAfter(int e) const;
  // False: the step was faulty and is not recorded.
  bool StepOne(int e);
  void OnFault(int e, const worlds::EpisodeFault& fault);
  void PlayAgain(int e, const EpisodeState& state);
  // Key of the episode that local environment `e` plays.
  uint64_t StreamKeyOf(StreamRole role, int e) const;
  void FillHeader(int e, RecordKind kind, RecordHeader* header) const;
  // Publishes the goal's picture, before the episode's reset, which is in `record`.
  void PublishGoal(int e, uint8_t* record);
  void Publish(uint8_t* record);

  const Options options_;
  const RecordLayout layout_;
  const bool goal_pictures_;
  SequenceLog& made_;
  RecordSink& sink_;
  ActionSelector& selector_;
  std::vector<Slot> slots_;
  std::vector<uint8_t> reset_;  // a record, while its episode's goal is published
  EpisodeLog episodes_;
  FaultLog faults_;
  std::vector<bool> owed_;  // (E) of a vector step under way: who has not stepped; empty between
  double environment_seconds_ = 0, inference_seconds_ = 0;
  uint64_t env_steps_ = 0;
  bool uniform_ = false;  // the warm-up's actions are being played
};

}  // namespace shoal::actor
