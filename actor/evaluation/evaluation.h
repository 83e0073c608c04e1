// SPDX-License-Identifier: Apache-2.0
// Deterministic evaluation of a policy over whole episodes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "actor/acting/action_selector.h"
#include "actor/acting/environments.h"
#include "actor/acting/episode_runner.h"
#include "actor/acting/fault_log.h"
#include "actor/evaluation/evaluation_environments.h"
#include "actor/evaluation/failure_cause.h"
#include "actor/evaluation/frame_recorder.h"
#include "actor/worlds/environment.h"
#include "common/config/run_config.h"
#include "common/run_folder/evaluation_file.h"

namespace shoal::actor {

struct EpisodeResult {
  int64_t seed = 0;  // number of the episode in its stream
  EpisodeFigures figures;
  // For tasks that have causes of failure (failure_cause.h): the goal and the achieved goal at the
  // end, in m, and the cause if the episode failed.
  std::vector<double> desired{}, achieved{};
  std::optional<FailureCause> failure{};
  // The fault of a faulty episode, which counts as failed: it ended, or could not begin, because a
  // number of the simulation was not finite.
  std::optional<worlds::FaultCause> fault{};
};

// Which episodes are played: episode k starts from StreamKey(seed, role, group, k). Train,
// evaluation and final streams never meet; `group` makes each evaluation's episodes fresh.
struct EpisodeStream {
  int64_t seed = 0;
  StreamRole role = StreamRole::kEvalEnvironment;
  uint64_t group = 0;
  uint64_t Key(int64_t episode) const {
    return StreamKey(static_cast<uint64_t>(seed), role, group, static_cast<uint64_t>(episode));
  }
};

// Stream of the episodes that evaluate a checkpoint of a run. The evaluation of a draining run may
// have the env steps of the evaluation before; the updates since then give it other episodes. The
// same checkpoint, evaluated again after a restart, gets the same episodes.
EpisodeStream EvaluationStream(int64_t seed, uint64_t env_steps, uint64_t updates);

// The part of eval/*.json that names the source of its numbers.
struct EvaluationLabel {
  std::string policy;           // "checkpoint" | "random" | "noop"
  std::string checkpoint = "";  // folder name; empty, as version, unless policy = "checkpoint"
  WeightsVersion version = {};
  uint64_t env_steps = 0;
};

// Environments stepped together and the policy that acts in them. One thread.
class Evaluator {
 public:
  // Throws Error when the environment's spec is not the run's. `noop`: every action is zero,
  // whatever the policy. `make`: the task's environments; tests bring cheaper ones.
  explicit Evaluator(const RunConfig& run, bool noop = false,
                     const EnvironmentFactory& make = MakeEnvironments);

  ActionSelector& selector() { return selector_; }
  // Calls the listener, which is borrowed, for every episode from now on. CHECK: there is one
  // environment, so that episodes follow one another.
  void Listen(EpisodeListener* listener);

  // Plays `episodes` whole episodes, actions by the mean of the policy (or uniform random before
  // any weights). `stop` is called after each step. If it returns true before all have ended,
  // returns the leading episodes that have ended, so that short episodes are not preferred. After
  // each episode `on_ended` receives the number of ended ones. Faulty episodes are logged; they are
  // no error, however many there are.
  std::vector<EpisodeResult> Play(int episodes, const EpisodeStream& stream,
                                  const std::function<bool()>& stop,
                                  const std::function<void(int ended)>& on_ended = {});

 private:
  struct Player {
    EpisodeRunner runner;
    FailureFacts facts;
    int64_t episode = 0;
    bool begun = false;  // the episode has a first observation
  };

  // State of a call of Play.
  struct Played {
    std::vector<EpisodeResult> results;
    std::vector<bool> ended;
    int begun = 0, done = 0;
  };

  // Gives environment `e` the next episode that can begin, if any is left.
  void Begin(int e, const EpisodeStream& stream, Played* played);
  void Step(int e, Played* played);
  void End(const Player& player, std::optional<worlds::FaultCause> fault, Played* played);

  const RunConfig run_;
  const std::vector<float> noop_;  // the action of every step; empty = the policy's
  ActionSelector selector_;
  std::vector<Player> players_;
  FaultLog faults_{/*max_share=*/2};
  // Buffer for the newest observation of an environment, until it is in the policy's input.
  std::vector<uint8_t> frame_;
  std::vector<float> vector_;
};

// The content of eval/*.json for these episodes (common/run_folder/evaluation_file.h).
EvaluationFile MakeEvaluation(const RunConfig& run, const EvaluationLabel& label,
                              const EpisodeStream& stream,
                              const std::vector<EpisodeResult>& episodes);
// ToJson of it.
nlohmann::ordered_json EvaluationJson(const RunConfig& run, const EvaluationLabel& label,
                                      const EpisodeStream& stream,
                                      const std::vector<EpisodeResult>& episodes);

struct CheckpointEvaluation {
  int episodes = 100;
  int64_t seed = 1;
  // Another task to play than the run's (see WithTask), named beside the run's own as trained_task;
  // empty = the run's.
  std::string task = "";
  // Destination of frames, if any; the episodes are then played one after the other.
  std::optional<FrameRecorder::Options> frames = {};
  // If asked to stop, the result is that of the episodes played so far, with `episodes_asked`, if
  // there are any.
  bool partial = false;
  // Called after each episode with the number of ended ones.
  std::function<void(int ended)> on_ended = {};
};
// Plays fresh episodes (final stream of the seed) with the policy of a checkpoint folder of the
// run. Throws Error when it is asked to stop, unless `partial` is set.
nlohmann::ordered_json EvaluateCheckpoint(
    const std::filesystem::path& run, const std::filesystem::path& checkpoint,
    const CheckpointEvaluation& evaluation,
    const EvaluationEnvironments& environments = WorldEnvironments());

}  // namespace shoal::actor
