// SPDX-License-Identifier: Apache-2.0
// eval/*.json of a run (schema shoal-eval-1): one evaluation of a policy, episode by episode. The
// process that plays the episodes writes the file. The coordinator adds wall_seconds to the
// evaluations of its run. Readers are the coordinator of a resumed run, reports and experiments.
//
//   {schema, task, policy, checkpoint, weights_version: {session, update}, env_steps,
//    deterministic, cameras, seeds: [seed], stream: {role, group},
//    episodes: [{seed, success, return, length, final_distance, action_smoothness,
//                desired_goal, achieved_goal, failure, fault, body_mass: {body: kg}}],
//    aggregate: {episodes, success_rate, return_mean, return_std, length_mean,
//                final_distance_mean, faulty_episodes},
//    commit, created, end_on_success, failures: {cause: episodes}, episodes_asked,
//    trained_task, wall_seconds}
//
// Success and distances are null if the task has none. checkpoint and weights_version are null for
// a policy without parameters. The following members are optional:
//
//   desired_goal, achieved_goal, failure, failures   if the task has causes of failure; `failure`
//                     is null for a successful episode
//   body_mass         for randomized episodes
//   fault             (diverged, observation, reward) for a faulty episode, which failed because a
//                     number of the simulation was not finite
//   faulty_episodes   if at least one episode was faulty
//   end_on_success    if true
//   episodes_asked    if fewer episodes were played than requested
//   trained_task      if the evaluation's task is not the task of the run
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shoal {

struct EvaluatedEpisode {
  int64_t seed = 0;  // number of the episode in its stream
  std::optional<bool> success{};
  double episode_return = 0;
  int64_t length = 0;         // env steps
  double final_distance = 0;  // m; not finite if the task has no distance
  double action_smoothness = 0;
  // The goal, and the achieved goal at the end, in m; for tasks that have causes of failure.
  struct Goal {
    std::vector<double> desired, achieved;
    std::string failure{};  // cause of failure; empty for a successful episode
  };
  std::optional<Goal> goal{};
  std::string fault{};  // why a faulty episode ended; empty for other episodes
  std::vector<std::pair<std::string, double>> body_mass_kg{};
};

struct EvaluationAggregate {
  size_t episodes = 0;
  std::optional<double> success_rate{};
  double return_mean = 0;
  std::optional<double> return_std{};           // files of early versions have none
  double length_mean = 0;                       // env steps
  std::optional<double> final_distance_mean{};  // m; over the episodes that have a distance
  size_t faulty_episodes = 0;                   // counted in `episodes`, as failed
};

// The line "  3 of 50 episodes ended at a number that is not finite and count as failed\n"; empty
// if no episode was faulty.
std::string FaultyEpisodesText(const EvaluationAggregate& aggregate);

// The part of an evaluation that programs read.
struct EvaluationSummary {
  std::string task{};
  // Name of the checkpoint's folder, and version of the parameters. Empty unless the policy is that
  // of a checkpoint.
  struct Version {
    uint64_t session = 0, update = 0;
  };
  std::optional<std::string> checkpoint{};
  std::optional<Version> version{};
  uint64_t env_steps = 0;
  double wall_seconds = 0;  // since the run's start; 0 = unknown
  EvaluationAggregate aggregate{};
};

// The whole file.
struct EvaluationFile {
  EvaluationSummary summary{};
  std::string policy{};  // "checkpoint" | "random" | "noop"
  bool deterministic = true;
  std::vector<std::string> cameras{};
  int64_t seed = 0;
  uint64_t stream_role = 0, stream_group = 0;
  std::vector<EvaluatedEpisode> episodes{};
  std::string commit{}, created{};
  bool end_on_success = false;
  // Failed episodes by cause, in the order in which causes are checked; empty for a task without
  // causes.
  std::optional<std::vector<std::pair<std::string, size_t>>> failures{};
  std::optional<int> episodes_asked{};
  std::optional<std::string> trained_task{};
};

nlohmann::ordered_json ToJson(const EvaluationFile& file);

// Parses `text`; `source` names the text in errors. Throws Error unless it is an object of this
// schema.
nlohmann::ordered_json ParseEvaluationObject(const std::string& text, const std::string& source);

// Throws Error naming `source` and the member if a member is missing or has another type. Does not
// check whether the numbers are plausible.
EvaluationSummary SummaryOf(const nlohmann::ordered_json& evaluation, const std::string& source);

void SetWallSeconds(double wall_seconds, nlohmann::ordered_json* evaluation);

}  // namespace shoal
