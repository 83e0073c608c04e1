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
  // Desired and achieved goal at the end, in m, and the cause if the episode failed. Empty for
  // tasks without causes of failure (failure_cause.h).
  std::vector<double> desired{}, achieved{};
  std::optional<FailureCause> failure{};
  // The fault of a faulty episode: the episode ended, or could not begin, because a number of the
  // simulation was not finite. A faulty episode counts as failed.
  std::optional<worlds::FaultCause> fault{};
};

// Selects the episodes that are played: episode k starts from StreamKey(seed, role, group, k). The
// roles (training, evaluation, final evaluation) share no episodes. Each evaluation has its own
// `group`, and therefore new episodes.
struct EpisodeStream {
  int64_t seed = 0;
  StreamRole role = StreamRole::kEvalEnvironment;
  uint64_t group = 0;
  uint64_t Key(int64_t episode) const {
    return StreamKey(static_cast<uint64_t>(seed), role, group, static_cast<uint64_t>(episode));
  }
};

// Stream of the episodes that evaluate a checkpoint of a run. At the end of a run, two evaluations
// may have the same env steps; their numbers of updates then select different episodes.
// A checkpoint that is evaluated again after a restart gets the same episodes.
EpisodeStream EvaluationStream(int64_t seed, uint64_t env_steps, uint64_t updates);

// The part of eval/*.json that names the source of its numbers.
struct EvaluationLabel {
  std::string policy;           // "checkpoint" | "random" | "noop"
  std::string checkpoint = "";  // folder name; empty (like version) unless policy = "checkpoint"
  WeightsVersion version = {};
  uint64_t env_steps = 0;
};

// Environments that are stepped together, and the policy that acts in the environments. One thread.
class Evaluator {
 public:
  // Throws Error if the environment's spec differs from the run's spec. `noop`: every action is
  // zero. `make` makes the task's environments; tests use cheaper environments.
  explicit Evaluator(const RunConfig& run, bool noop = false,
                     const EnvironmentFactory& make = MakeEnvironments);

  ActionSelector& selector() { return selector_; }
  // Sets the listener of every later episode. The listener is borrowed. CHECK: there is only one
  // environment, so episodes do not overlap.
  void Listen(EpisodeListener* listener);

  // Plays `episodes` whole episodes with the mean action of the policy (or uniform random actions
  // if no weights are loaded). `stop` is called after each step. If `stop` returns true before all
  // episodes have ended, returns the ended episodes before the first episode that has not ended, so
  // short episodes are not preferred. After each episode `on_ended` receives the number of ended
  // episodes. Faulty episodes are logged; any number of faulty episodes is accepted.
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

  // Begins in environment `e` the next episode that can begin, if any is left.
  void Begin(int e, const EpisodeStream& stream, Played* played);
  void Step(int e, Played* played);
  void End(const Player& player, std::optional<worlds::FaultCause> fault, Played* played);

  const RunConfig run_;
  const std::vector<float> noop_;  // action of every step; empty = the policy's actions
  ActionSelector selector_;
  std::vector<Player> players_;
  FaultLog faults_{/*max_share=*/2};
  // Buffer for the newest observation of an environment.
  std::vector<uint8_t> frame_;
  std::vector<float> vector_;
};

// The content of eval/*.json for these episodes (common/run_folder/evaluation_file.h).
EvaluationFile MakeEvaluation(const RunConfig& run, const EvaluationLabel& label,
                              const EpisodeStream& stream,
                              const std::vector<EpisodeResult>& episodes);
// The content of MakeEvaluation as JSON.
nlohmann::ordered_json EvaluationJson(const RunConfig& run, const EvaluationLabel& label,
                                      const EpisodeStream& stream,
                                      const std::vector<EpisodeResult>& episodes);

struct CheckpointEvaluation {
  int episodes = 100;
  int64_t seed = 1;
  // Task to play in place of the run's task (see WithTask). The result then names the run's task as
  // trained_task. Empty = the run's task.
  std::string task = "";
  // Destination of recorded frames, if any. Episodes are then played one after the other.
  std::optional<FrameRecorder::Options> frames = {};
  // If true, a stopped evaluation returns the result of the episodes played so far. The result then
  // also has `episodes_asked`. If no episode has been played, Error is thrown as if `partial` were
  // false.
  bool partial = false;
  // Called after each episode with the number of ended episodes.
  std::function<void(int ended)> on_ended = {};
};
// Plays new episodes (final stream of the seed) with the policy of a checkpoint folder of the run.
// Throws Error if a stop is requested, unless `partial` is set.
nlohmann::ordered_json EvaluateCheckpoint(
    const std::filesystem::path& run, const std::filesystem::path& checkpoint,
    const CheckpointEvaluation& evaluation,
    const EvaluationEnvironments& environments = WorldEnvironments());

}  // namespace shoal::actor
