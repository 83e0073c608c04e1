#include "actor/evaluation.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "actor/environments.h"
#include "actor/frame_stack.h"
#include "actor/other_task.h"
#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

using nlohmann::ordered_json;

// One environment's part of an evaluation.
struct Seat {
  worlds::Environment* environment;
  FrameStack stack;
  std::vector<uint8_t> frame;
  std::vector<float> last_action;
  EpisodeResult result;
  bool running = false;
};

void Begin(Seat& seat, int e, int64_t episode, const EpisodeStream& stream,
           ActionSelector& selector) {
  seat.result = {.seed = episode};
  seat.running = true;
  seat.last_action.clear();
  const uint64_t key = stream.Key(episode);
  // Only a policy without weights draws: uniform random actions, apart from the environment's
  // draws.
  selector.BeginEpisode(e, HashWords({key, static_cast<uint64_t>(StreamRole::kEvalPolicy)}));
  seat.environment->Reset(key, {seat.frame, selector.VectorOf(e)});
  const auto masses = seat.environment->drawn_masses();
  seat.result.drawn_masses.assign(masses.begin(), masses.end());
  seat.stack.Reset(seat.frame);
}

// True when the episode ended.
bool Advance(Seat& seat, int e, ActionSelector& selector) {
  const std::span<const float> action = selector.ActionOf(e);
  const worlds::StepResult step =
      seat.environment->Step(action, {seat.frame, selector.VectorOf(e)});
  seat.stack.Push(seat.frame);
  EpisodeResult& result = seat.result;
  if (!seat.last_action.empty()) {
    double squared = 0;
    for (size_t a = 0; a < action.size(); ++a) {
      squared += std::pow(double{action[a]} - double{seat.last_action[a]}, 2);
    }
    result.action_smoothness += std::sqrt(squared);
  }
  seat.last_action.assign(action.begin(), action.end());
  ++result.length;
  result.episode_return += step.reward;
  if (!step.terminated && !step.truncated) return false;
  result.success = step.success;
  result.final_distance = step.distance;
  if (result.length > 1) result.action_smoothness /= result.length - 1;
  seat.running = false;
  return true;
}

ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json EpisodeJson(const EpisodeResult& episode, bool has_success) {
  ordered_json object{{"seed", episode.seed},
                      {"success", has_success ? ordered_json(episode.success) : nullptr},
                      {"return", episode.episode_return},
                      {"length", episode.length},
                      {"final_distance", NumberOrNull(episode.final_distance)},
                      {"action_smoothness", episode.action_smoothness}};
  for (const worlds::DrawnMass& drawn : episode.drawn_masses) {
    object["body_mass"][drawn.body] = drawn.mass_kg;
  }
  return object;
}

ordered_json Aggregate(const std::vector<EpisodeResult>& episodes, bool has_success) {
  const double n = static_cast<double>(episodes.size());
  double successes = 0, mean = 0, length = 0, distance = 0, variance = 0;
  for (const EpisodeResult& episode : episodes) {
    successes += episode.success;
    mean += episode.episode_return / n;
    length += episode.length / n;
    distance += episode.final_distance / n;
  }
  for (const EpisodeResult& episode : episodes) {
    variance += std::pow(episode.episode_return - mean, 2) / n;
  }
  return {{"episodes", episodes.size()},
          {"success_rate", has_success ? ordered_json(successes / n) : nullptr},
          {"return_mean", mean},
          {"return_std", std::sqrt(variance)},
          {"length_mean", length},
          {"final_distance_mean", NumberOrNull(distance)}};
}

}  // namespace

Evaluator::Evaluator(const RunConfig& run)
    : run_(run),
      environments_(MakeEnvironments(run, run.config.eval.envs)),
      selector_(run.config, run.spec, run.config.eval.envs) {}

std::vector<EpisodeResult> Evaluator::Play(int episodes, const EpisodeStream& stream,
                                           const std::function<bool()>& stop) {
  std::vector<Seat> seats;
  for (size_t e = 0; e < environments_.size(); ++e) {
    seats.push_back({.environment = environments_[e].get(),
                     .stack = FrameStack(selector_.FrameStackOf(int(e)), run_.spec.FrameBytes()),
                     .frame = std::vector<uint8_t>(size_t(run_.spec.FrameBytes())),
                     .last_action = {},
                     .result = {}});
  }
  std::vector<EpisodeResult> results(static_cast<size_t>(episodes));
  int begun = 0, done = 0;
  while (done < episodes) {
    if (stop()) return {};
    for (size_t e = 0; e < seats.size(); ++e) {
      if (!seats[e].running && begun < episodes) {
        Begin(seats[e], int(e), begun++, stream, selector_);
      }
    }
    selector_.Select(/*deterministic=*/true);
    for (size_t e = 0; e < seats.size(); ++e) {
      if (!seats[e].running || !Advance(seats[e], int(e), selector_)) continue;
      results[static_cast<size_t>(seats[e].result.seed)] = seats[e].result;
      ++done;
    }
  }
  return results;
}

ordered_json EvaluationJson(const RunConfig& run, const EvaluationLabel& label,
                            const EpisodeStream& stream,
                            const std::vector<EpisodeResult>& episodes) {
  const bool has_success = tasks::FindTask(run.config.task).has_success();
  ordered_json list = ordered_json::array();
  for (const EpisodeResult& episode : episodes) {
    list.push_back(EpisodeJson(episode, has_success));
  }
  const bool random = label.policy == "random";
  const ordered_json version{{"session", label.version.session}, {"update", label.version.update}};
  return {{"schema", "shoal-eval-1"},
          {"task", run.config.task},
          {"policy", label.policy},
          {"checkpoint", random ? ordered_json(nullptr) : ordered_json(label.checkpoint)},
          {"weights_version", random ? ordered_json(nullptr) : version},
          {"env_steps", label.env_steps},
          {"deterministic", !random},
          {"cameras", run.spec.cameras},
          {"seeds", {stream.seed}},
          {"stream", {{"role", static_cast<uint64_t>(stream.role)}, {"group", stream.group}}},
          {"episodes", list},
          {"aggregate", Aggregate(episodes, has_success)},
          {"commit", BuildCommit()},
          {"created", UtcTimestamp()}};
}

ordered_json EvaluateCheckpoint(const std::filesystem::path& run_folder,
                                const std::filesystem::path& checkpoint, int episodes, int64_t seed,
                                const std::string& task) {
  const RunConfig trained = ReadRunConfig(run_folder);
  const RunConfig run = task.empty() ? trained : WithTask(trained, task);
  CheckpointFiles files = ReadCheckpointFiles(checkpoint, trained.spec.Hash());
  const EvaluationLabel label{.policy = "checkpoint",
                              .checkpoint = checkpoint.filename().string(),
                              .version = {files.state.learner_session, files.state.updates},
                              .env_steps = files.state.env_steps};
  Evaluator evaluator(run);
  evaluator.selector().Load({.version = label.version,
                             .env_steps = label.env_steps,
                             .checkpoint = label.checkpoint,
                             .payload = std::move(files.policy)});
  const EpisodeStream stream{seed, StreamRole::kFinalEnvironment, 0};
  const std::vector<EpisodeResult> results = evaluator.Play(episodes, stream, StopRequested);
  if (results.empty()) throw RuntimeError("evaluation of '{}' interrupted", checkpoint.string());
  ordered_json result = EvaluationJson(run, label, stream, results);
  if (!task.empty()) result["trained_task"] = trained.config.task;
  return result;
}

}  // namespace shoal::actor
