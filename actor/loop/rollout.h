// SPDX-License-Identifier: Apache-2.0
// Rollout of E environments that are stepped together. Each reset and each step gives one record.
//
// Resets take longer than steps, and all environments wait for each reset. If all environments
// begin an episode in the same step, as at the start, these episodes are cut short. The
// environments then reset at different steps:
//
//   environment e of E truncates its episode after ceil(L (e + 1) / E) env steps; a whole episode
//   has L env steps.
//
// A faulty episode (actor/worlds/episode_fault.h) ends at its last finite observation. The faulty
// step is not recorded. The environment begins another episode and makes a step in this episode.
// Every vector step therefore still has one step record of each environment, and budgets, lockstep
// and on-policy rollouts count the same steps as without faults. The replay closes the faulty
// episode when the next episode begins.
//
// Borrows the constructor's arguments, except the environments. One thread.
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
  double physics = 0;  // everything that an environment does except rendering
  double rendering = 0;
  // Stages of a user's own environments.
  double user_code = 0;   // reset and step of the user's code
  double conversion = 0;  // between the user's arrays and Shoal's, and everything else
  double inference = 0;
};

class Rollout {
 public:
  struct Options {
    int64_t seed = 0;        // the run's
    uint32_t first_env = 0;  // number of the first environment within the run
    // This actor's share of exploration.random_steps (own), and the total (run). The warm-up ends
    // when the actor's env steps reach the share or the run's env steps reach the total. An actor
    // that was restarted or joined late therefore does not repeat the warm-up.
    uint64_t own_random_steps = 0, run_random_steps = 0;
    int episode_steps = 0;        // L
    double max_faulty_share = 0;  // limit of FaultLog

    static Options Of(const Config& config, uint32_t first_env);
  };
  // `environments` have the observation spec `spec`; their number is that of the selector.
  Rollout(const Options& options, const ObservationSpec& spec,
          std::vector<std::unique_ptr<worlds::Environment>> environments, SequenceLog& made,
          RecordSink& sink, ActionSelector& selector);

  // Steps every environment once. If an environment's episode has ended, begins its next episode
  // first. Returns false, and does nothing, while the sink cannot take the records. Also returns
  // false after a faulty step: the next call then steps the environments that have not yet made
  // their step. Throws Error (kNonFinite) if the share of faulty episodes exceeds max_faulty_share.
  bool TryStep();

  // Ends the running episodes; the next step begins new episodes. Needed when the receiver is a new
  // process, which does not have the first records of the running episodes.
  void AbandonEpisodes();

  // The present state. The caller fills in `session` and `made`.
  RolloutState State() const;
  // Continues from another process's state: replays the running episodes from their actions and
  // publishes nothing. Call it before the first step. Throws Error if the state was made with other
  // environments.
  void Restore(const RolloutState& state);

  // Steps of this actor, counted from the run's start if the state was restored, otherwise from the
  // actor's start.
  uint64_t env_steps() const { return env_steps_; }
  int64_t vector_steps() const { return static_cast<int64_t>(env_steps_ / slots_.size()); }
  // Statistics of the ended episodes. Episodes with a cut (CutAfter) are left out: only short
  // episodes end before the cut, so these episodes would bias the statistics.
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
  // Begins an episode in each environment that owes a step and has no running episode.
  void BeginEpisodes();
  void BeginEpisode(int e, int cut_after);
  // Resets the environment and skips episodes that cannot begin. Writes the reset to `record`.
  void ResetRunner(int e, int cut_after, uint8_t* record);
  // Number of env steps after which an episode is cut if all environments begin an episode in the
  // same step; 0 = no cut.
  int CutAfter(int e) const;
  // Returns false if the step was faulty and is not recorded.
  bool StepOne(int e);
  void OnFault(int e, const worlds::EpisodeFault& fault);
  void PlayAgain(int e, const EpisodeState& state);
  // Key of the episode that local environment `e` plays.
  uint64_t StreamKeyOf(StreamRole role, int e) const;
  void FillHeader(int e, RecordKind kind, RecordHeader* header) const;
  // Publishes the goal's picture before the episode's reset. `record` holds the reset.
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
  std::vector<bool> owed_;  // (E) environments that still owe a step; empty between vector steps
  double environment_seconds_ = 0, inference_seconds_ = 0;
  uint64_t env_steps_ = 0;
  bool uniform_ = false;  // the warm-up is running
};

}  // namespace shoal::actor
