// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "common/base/build_info.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/run_files.h"
#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

using nlohmann::ordered_json;

tasks::Task PlayedTask(const Config& config) {
  return tasks::FindTask(config.task, config.distance_threshold);
}

EvaluatedEpisode EpisodeOf(const EpisodeResult& result, bool has_success, bool has_causes) {
  const EpisodeFigures& figures = result.figures;
  EvaluatedEpisode episode{.seed = result.seed,
                           .success = has_success ? std::optional(figures.success) : std::nullopt,
                           .episode_return = figures.episode_return,
                           .length = figures.length,
                           .final_distance = figures.final_distance,
                           .action_smoothness = figures.action_smoothness};
  if (has_causes) {
    episode.goal = {.desired = result.desired,
                    .achieved = result.achieved,
                    .failure = std::string(result.failure ? NameOf(*result.failure) : "")};
  }
  if (result.fault) episode.fault = worlds::NameOf(*result.fault);
  for (const worlds::DrawnMass& drawn : figures.drawn_masses) {
    episode.body_mass_kg.emplace_back(drawn.body, drawn.mass_kg);
  }
  return episode;
}

EvaluationAggregate Aggregate(const std::vector<EpisodeResult>& episodes, bool has_success) {
  const double n = static_cast<double>(episodes.size());
  double successes = 0, mean = 0, length = 0, distance = 0, variance = 0;
  size_t faulty = 0, distances = 0;
  for (const EpisodeResult& result : episodes) {
    const EpisodeFigures& episode = result.figures;
    successes += episode.success;
    mean += episode.episode_return / n;
    length += episode.length / n;
    faulty += result.fault.has_value();
    if (!std::isfinite(episode.final_distance)) continue;  // no goals, or the episode never began
    distance += episode.final_distance;
    ++distances;
  }
  for (const EpisodeResult& result : episodes) {
    variance += std::pow(result.figures.episode_return - mean, 2) / n;
  }
  EvaluationAggregate aggregate{.episodes = episodes.size(),
                                .return_mean = mean,
                                .return_std = std::sqrt(variance),
                                .length_mean = length,
                                .faulty_episodes = faulty};
  if (has_success) aggregate.success_rate = successes / n;
  if (distances > 0) aggregate.final_distance_mean = distance / static_cast<double>(distances);
  return aggregate;
}

// Counts in the order of `causes`.
std::vector<std::pair<std::string, size_t>> FailureCounts(
    std::span<const FailureCause> causes, const std::vector<EpisodeResult>& episodes) {
  std::vector<std::pair<std::string, size_t>> counts;
  for (const FailureCause cause : causes) {
    const auto count = std::ranges::count(episodes, std::optional(cause), &EpisodeResult::failure);
    counts.emplace_back(NameOf(cause), static_cast<size_t>(count));
  }
  return counts;
}

}  // namespace

Evaluator::Evaluator(const RunConfig& run, bool noop, const EnvironmentFactory& make)
    : run_(run),
      noop_(noop ? static_cast<size_t>(run.spec.action_size) : 0),
      selector_(run.config, run.spec, run.config.eval.envs),
      frame_(static_cast<size_t>(run.spec.FrameBytes())),
      vector_(static_cast<size_t>(run.spec.RecordedVectorSize())) {
  int e = 0;
  for (auto& environment : make(run, run.config.eval.envs)) {
    const EpisodeRunner::PolicyInput input{selector_.FrameStackOf(e), selector_.VectorOf(e)};
    players_.push_back({.runner = EpisodeRunner(std::move(environment), input),
                        .facts = FailureFacts(run.spec, PlayedTask(run.config))});
    ++e;
  }
}

EpisodeStream EvaluationStream(int64_t seed, uint64_t env_steps, uint64_t updates) {
  return {seed, StreamRole::kEvalEnvironment, HashWords({env_steps, updates})};
}

void Evaluator::Listen(EpisodeListener* listener) {
  CHECK(players_.size() == 1) << players_.size();
  players_[0].runner.set_listener(listener);
}

void Evaluator::Begin(int e, const EpisodeStream& stream, Played* played) {
  Player& player = players_[static_cast<size_t>(e)];
  while (!player.runner.running() && played->begun < static_cast<int>(played->results.size())) {
    player.episode = played->begun++;
    player.begun = false;
    const uint64_t key = stream.Key(player.episode);
    // Only a policy without weights draws here: its actions are uniform and have a stream apart
    // from the environment's.
    selector_.BeginEpisode(e, HashWords({key, static_cast<uint64_t>(StreamRole::kEvalPolicy)}));
    try {
      player.runner.Begin(key, {frame_, vector_});
      player.facts.Begin(vector_);
      player.begun = true;
    } catch (const worlds::EpisodeFault& fault) {
      faults_.Count(fault);
      End(player, fault.cause(), played);
    }
  }
}

void Evaluator::Step(int e, Played* played) {
  Player& player = players_[static_cast<size_t>(e)];
  try {
    player.runner.Step(noop_.empty() ? selector_.ActionOf(e) : noop_, {frame_, vector_});
  } catch (const worlds::EpisodeFault& fault) {
    faults_.Count(fault);
    End(player, fault.cause(), played);
    return;
  }
  player.facts.Step(vector_);
  if (!player.runner.running()) End(player, std::nullopt, played);
}

void Evaluator::End(const Player& player, std::optional<worlds::FaultCause> fault, Played* played) {
  EpisodeResult& result = played->results[static_cast<size_t>(player.episode)];
  result = {.seed = player.episode, .figures = player.runner.figures(), .fault = fault};
  if (!player.begun) result.figures.final_distance = std::numeric_limits<double>::quiet_NaN();
  played->ended[static_cast<size_t>(player.episode)] = true;
  ++played->done;
  if (!player.facts.applies()) return;
  if (player.begun) {
    result.desired = player.facts.desired();
    result.achieved = player.facts.achieved();
  }
  if (result.figures.success) return;
  result.failure = fault ? FailureCause::kNotFinite : player.facts.Cause();
}

std::vector<EpisodeResult> Evaluator::Play(int episodes, const EpisodeStream& stream,
                                           const std::function<bool()>& stop,
                                           const std::function<void(int ended)>& on_ended) {
  for (Player& player : players_) player.runner.Abandon();  // left by a stopped call
  Played played;
  played.results.resize(static_cast<size_t>(episodes));
  played.ended.resize(played.results.size());
  const int envs = static_cast<int>(players_.size());
  int told = 0;
  while (played.done < episodes) {
    if (stop()) {
      // Later episodes are left out: those that have ended are the short ones.
      const auto first_missing = std::ranges::find(played.ended, false);
      played.results.resize(static_cast<size_t>(first_missing - played.ended.begin()));
      return played.results;
    }
    for (int e = 0; e < envs; ++e) Begin(e, stream, &played);
    selector_.Select(Acting::kMean);
    for (int e = 0; e < envs; ++e) {
      if (players_[static_cast<size_t>(e)].runner.running()) Step(e, &played);
    }
    while (on_ended && told < played.done) on_ended(++told);
  }
  return played.results;
}

EvaluationFile MakeEvaluation(const RunConfig& run, const EvaluationLabel& label,
                              const EpisodeStream& stream,
                              const std::vector<EpisodeResult>& episodes) {
  const bool has_success = tasks::FindTask(run.config.task).has_success();
  const FailureFacts causes(run.spec, PlayedTask(run.config));
  EvaluationFile file{.summary = {.task = run.config.task,
                                  .env_steps = label.env_steps,
                                  .aggregate = Aggregate(episodes, has_success)},
                      .policy = label.policy,
                      .deterministic = label.policy != "random",
                      .cameras = run.spec.cameras,
                      .seed = stream.seed,
                      .stream_role = static_cast<uint64_t>(stream.role),
                      .stream_group = stream.group,
                      .commit = BuildCommit(),
                      .created = UtcTimestamp(),
                      .end_on_success = run.config.end_on_success};
  if (label.policy == "checkpoint") {
    file.summary.checkpoint = label.checkpoint;
    file.summary.version = {label.version.session, label.version.update};
  }
  for (const EpisodeResult& episode : episodes) {
    file.episodes.push_back(EpisodeOf(episode, has_success, causes.applies()));
  }
  if (causes.applies()) file.failures = FailureCounts(causes.causes(), episodes);
  return file;
}

ordered_json EvaluationJson(const RunConfig& run, const EvaluationLabel& label,
                            const EpisodeStream& stream,
                            const std::vector<EpisodeResult>& episodes) {
  return ToJson(MakeEvaluation(run, label, stream, episodes));
}

namespace {

// A card (shoal card) contains the policy's files only.
CheckpointFiles FilesToActBy(const std::filesystem::path& checkpoint, uint64_t spec_hash) {
  if (std::filesystem::exists(checkpoint / kLearnerFile)) {
    return ReadCheckpointFiles(checkpoint, spec_hash);
  }
  CheckpointFiles files = ReadPolicyFiles(checkpoint);
  if (files.state.spec_hash != spec_hash) {
    throw RuntimeError("'{}' is of another observation spec than the config.json beside it",
                       checkpoint.string());
  }
  return files;
}

}  // namespace

ordered_json EvaluateCheckpoint(const std::filesystem::path& run_folder,
                                const std::filesystem::path& checkpoint,
                                const CheckpointEvaluation& evaluation,
                                const EvaluationEnvironments& environments) {
  const RunConfig trained = ReadRunConfig(run_folder);
  RunConfig run =
      evaluation.task.empty() ? trained : environments.with_task(trained, evaluation.task);
  // A recorder listens to one environment only.
  if (evaluation.frames) run.config.eval.envs = 1;
  CheckpointFiles files = FilesToActBy(checkpoint, trained.spec.Hash());
  const EvaluationLabel label{.policy = "checkpoint",
                              .checkpoint = checkpoint.filename().string(),
                              .version = {files.state.learner_session, files.state.updates},
                              .env_steps = files.state.env_steps};
  Evaluator evaluator(run, /*noop=*/false, environments.make);
  evaluator.selector().Load({.version = label.version,
                             .env_steps = label.env_steps,
                             .checkpoint = label.checkpoint,
                             .payload = std::move(files.policy)});
  std::optional<FrameRecorder> recorder;
  if (evaluation.frames) {
    evaluator.Listen(&recorder.emplace(run.spec, evaluation.frames->file,
                                       environments.view(run, *evaluation.frames)));
  }
  const EpisodeStream stream{evaluation.seed, StreamRole::kFinalEnvironment, 0};
  const std::vector<EpisodeResult> results =
      evaluator.Play(evaluation.episodes, stream, StopRequested, evaluation.on_ended);
  const bool whole = results.size() == static_cast<size_t>(evaluation.episodes);
  if (!whole && (!evaluation.partial || results.empty())) {
    throw Interrupted(fmt::format("evaluation of '{}'", checkpoint.string()));
  }
  EvaluationFile file = MakeEvaluation(run, label, stream, results);
  if (!whole) file.episodes_asked = evaluation.episodes;
  if (!evaluation.task.empty()) file.trained_task = trained.config.task;
  return ToJson(file);
}

}  // namespace shoal::actor
