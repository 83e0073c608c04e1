// Deterministic evaluation of a policy over whole episodes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "actor/action_selector.h"
#include "actor/worlds/environment.h"
#include "common/config/run_files.h"

namespace shoal::actor {

struct EpisodeResult {
  int64_t seed = 0;              // number of the episode in its stream
  bool success = false;          // false where the task has none
  double episode_return = 0;     // unscaled
  int length = 0;                // env steps
  double final_distance = 0;     // m; NaN where the task has none
  double action_smoothness = 0;  // mean over steps of |a_t - a_{t-1}|_2; smaller is smoother
  std::vector<worlds::DrawnMass> drawn_masses{};  // empty unless randomized
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

// What eval/*.json says about where the numbers come from.
struct EvaluationLabel {
  std::string policy;           // "checkpoint" | "random": then there is no checkpoint and version
  std::string checkpoint = "";  // folder name
  WeightsVersion version = {};
  uint64_t env_steps = 0;
};

// Environments stepped together and the policy that acts in them. One thread.
class Evaluator {
 public:
  // Throws Error when the environment's spec is not the run's.
  explicit Evaluator(const RunConfig& run);

  ActionSelector& selector() { return selector_; }

  // Plays `episodes` whole episodes, actions by the mean of the policy (or uniform random before
  // any weights). Empty when `stop`, asked after each step, said so before they were done.
  std::vector<EpisodeResult> Play(int episodes, const EpisodeStream& stream,
                                  const std::function<bool()>& stop);

 private:
  const RunConfig run_;
  std::vector<std::unique_ptr<worlds::Environment>> environments_;
  ActionSelector selector_;
};

// The object of eval/*.json, schema shoal-eval-1. success, success_rate, final_distance and its
// mean are null where the task has no such thing; body_mass (body -> kg) is there for randomized
// episodes.
nlohmann::ordered_json EvaluationJson(const RunConfig& run, const EvaluationLabel& label,
                                      const EpisodeStream& stream,
                                      const std::vector<EpisodeResult>& episodes);

// Plays fresh episodes (final stream of `seed`) with the policy of a checkpoint folder of the run.
// `task`: another one to play than the run's (see WithTask), named beside the run's own as
// trained_task; empty = the run's.
nlohmann::ordered_json EvaluateCheckpoint(const std::filesystem::path& run,
                                          const std::filesystem::path& checkpoint, int episodes,
                                          int64_t seed, const std::string& task);

}  // namespace shoal::actor
