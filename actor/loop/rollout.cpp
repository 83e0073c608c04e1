// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/rollout.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/sending_window.h"
#include "common/tasks/task_registry.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::actor {
namespace {

constexpr int kMostAttempts = 100;  // to begin one episode

}  // namespace

Rollout::Options Rollout::Options::Of(const Config& config, uint32_t first_env) {
  const tasks::Task& task = tasks::FindTask(config.task);
  return {.seed = config.seed,
          .first_env = first_env,
          .own_random_steps = RandomStepsOfActor(config),
          .run_random_steps = static_cast<uint64_t>(config.exploration.random_steps),
          .episode_steps = task.EnvStepsPerEpisode(task.ActionRepeat(config.action_repeat)),
          .max_faulty_share = config.max_faulty_share};
}

Rollout::Rollout(const Options& options, const ObservationSpec& spec,
                 std::vector<std::unique_ptr<worlds::Environment>> environments, SequenceLog& made,
                 RecordSink& sink, ActionSelector& selector)
    : options_(options),
      layout_(spec),
      goal_pictures_(spec.goal_picture),
      made_(made),
      sink_(sink),
      selector_(selector),
      faults_(options.max_faulty_share) {
  CHECK(!environments.empty());
  for (size_t e = 0; e < environments.size(); ++e) {
    const EpisodeRunner::PolicyInput input{selector.FrameStackOf(static_cast<int>(e)),
                                           selector.VectorOf(static_cast<int>(e))};
    slots_.push_back({.runner = EpisodeRunner(std::move(environments[e]), input), .actions = {}});
  }
}

bool Rollout::TryStep() {
  if (owed_.empty()) owed_.assign(slots_.size(), true);
  // After a faulty episode the environment begins another episode and still owes its step.
  while (const auto owing = static_cast<size_t>(std::ranges::count(owed_, true))) {
    if (sink_.Room() < static_cast<size_t>(MostRecordsOfStep(goal_pictures_)) * owing) return false;
    {
      const ScopedSeconds timed(environment_seconds_);
      BeginEpisodes();
    }
    {
      const ScopedSeconds timed(inference_seconds_);
      uniform_ = WarmingUp();
      selector_.Select(uniform_ ? Acting::kUniform : Acting::kExplore, owed_);
    }
    const ScopedSeconds timed(environment_seconds_);
    for (size_t e = 0; e < slots_.size(); ++e) {
      if (owed_[e]) owed_[e] = !StepOne(static_cast<int>(e));
    }
  }
  owed_.clear();
  env_steps_ += slots_.size();
  return true;
}

bool Rollout::WarmingUp() const {
  return env_steps_ < options_.own_random_steps &&
         selector_.run_env_steps() < options_.run_random_steps;
}

void Rollout::AbandonEpisodes() {
  for (Slot& slot : slots_) slot.runner.Abandon();
}

StageSeconds Rollout::seconds() const {
  StageSeconds seconds;
  for (const Slot& slot : slots_) {
    const worlds::Environment& environment = slot.runner.environment();
    seconds.rendering += environment.render_seconds();
    seconds.user_code += environment.user_seconds().value_or(0);
    seconds.users = seconds.users || environment.user_seconds().has_value();
  }
  (seconds.users ? seconds.conversion : seconds.physics) =
      environment_seconds_ - seconds.rendering - seconds.user_code;
  seconds.inference = inference_seconds_;
  return seconds;
}

void Rollout::BeginEpisodes() {
  const auto running = [](const Slot& slot) { return slot.runner.running(); };
  const bool together = std::ranges::none_of(slots_, running);
  for (int e = 0; e < static_cast<int>(slots_.size()); ++e) {
    if (owed_[static_cast<size_t>(e)] && !running(slots_[static_cast<size_t>(e)]))
      BeginEpisode(e, together ? CutAfter(e) : 0);
  }
}

int Rollout::CutAfter(int e) const {
  const auto envs = static_cast<int64_t>(slots_.size());
  const int64_t steps = (int64_t{options_.episode_steps} * (e + 1) + envs - 1) / envs;
  return steps < options_.episode_steps ? static_cast<int>(steps) : 0;
}

void Rollout::ResetRunner(int e, int cut_after, uint8_t* record) {
  Slot& slot = slots_[static_cast<size_t>(e)];
  // Attempts are bounded: with a high max_faulty_share, a task that can never begin would loop
  // forever.
  for (int attempts = 1;; ++attempts) {
    slot.episode = made_.TakeEpisode(static_cast<uint32_t>(e));
    slot.actions.clear();
    selector_.BeginEpisode(e, StreamKeyOf(StreamRole::kTrainPolicy, e));
    try {
      RecordLayout::Header(record).distance =
          slot.runner.Begin(StreamKeyOf(StreamRole::kTrainEnvironment, e),
                            {layout_.Frame(record), layout_.Vector(record)}, cut_after);
      return;
    } catch (const worlds::EpisodeFault& fault) {
      faults_.Count(fault);
      if (attempts < kMostAttempts) continue;
      throw NonFiniteError("{}; {} episodes in a row cannot begin", fault.what(), attempts);
    }
  }
}

void Rollout::BeginEpisode(int e, int cut_after) {
  uint8_t* record = sink_.BeginRecord();
  ResetRunner(e, cut_after, record);
  if (goal_pictures_) {
    // The goal's record precedes the reset's, but its picture exists only after the reset. The
    // reset is kept aside meanwhile.
    reset_.assign(record, record + layout_.record_bytes());
    PublishGoal(e, record);
    record = sink_.BeginRecord();
    std::ranges::copy(reset_, record);
  }
  FillHeader(e, RecordKind::kReset, &RecordLayout::Header(record));
  Publish(record);
}

void Rollout::PublishGoal(int e, uint8_t* record) {
  const std::span<const uint8_t> picture =
      slots_[static_cast<size_t>(e)].runner.environment().goal_picture();
  CHECK(picture.size() == static_cast<size_t>(layout_.frame_bytes())) << picture.size();
  std::ranges::copy(picture, layout_.Frame(record).begin());
  FillHeader(e, RecordKind::kGoal, &RecordLayout::Header(record));
  Publish(record);
}

void Rollout::OnFault(int e, const worlds::EpisodeFault& fault) {
  const EpisodeRunner& runner = slots_[static_cast<size_t>(e)].runner;
  faults_.Count(fault);
  if (runner.cut_after() == 0 && runner.figures().length > 0) episodes_.Add(runner.figures());
}

bool Rollout::StepOne(int e) {
  Slot& slot = slots_[static_cast<size_t>(e)];
  uint8_t* record = sink_.BeginRecord();
  const std::span<const float> action = selector_.ActionOf(e);
  std::copy(action.begin(), action.end(), layout_.Action(record).begin());
  slot.actions.insert(slot.actions.end(), action.begin(), action.end());
  std::ranges::copy(selector_.DrawnOf(e), layout_.DrawnAction(record).begin());
  worlds::StepResult result;
  try {
    result = slot.runner.Step(action, {layout_.Frame(record), layout_.Vector(record)});
  } catch (const worlds::EpisodeFault& fault) {
    OnFault(e, fault);  // the next step or reset reuses the open record
    return false;
  }

  RecordHeader& header = RecordLayout::Header(record);
  FillHeader(e, RecordKind::kStep, &header);
  header.reward = result.reward;
  header.distance = result.distance;
  header.log_prob = selector_.LogProbOf(e);
  header.flags =
      static_cast<uint8_t>((result.terminated ? kTerminated : 0) |
                           (result.truncated ? kTruncated : 0) | (result.success ? kSuccess : 0));
  Publish(record);
  if (!slot.runner.running()) {
    faults_.Ended();
    if (slot.runner.cut_after() == 0) episodes_.Add(slot.runner.figures());
  }
  return true;
}

RolloutState Rollout::State() const {
  RolloutState state;
  state.env_steps = env_steps_;
  for (int e = 0; e < static_cast<int>(slots_.size()); ++e) {
    const Slot& slot = slots_[static_cast<size_t>(e)];
    state.episodes.push_back(
        {.episode = slot.episode,
         .running = slot.runner.running(),
         .cut_after = slot.runner.running() ? slot.runner.cut_after() : 0,
         .owes = !owed_.empty() && owed_[static_cast<size_t>(e)],
         .noise = selector_.NoiseOf(e),
         .actions = slot.runner.running() ? slot.actions : std::vector<float>()});
  }
  return state;
}

void Rollout::Restore(const RolloutState& state) {
  CHECK(env_steps_ == 0);
  if (state.episodes.size() != slots_.size()) {
    throw RuntimeError("the actor's state is of {} environments, it has {}", state.episodes.size(),
                       slots_.size());
  }
  env_steps_ = state.env_steps;
  const auto owes = [](const EpisodeState& episode) { return episode.owes; };
  if (std::ranges::any_of(state.episodes, owes)) {
    for (const EpisodeState& episode : state.episodes) owed_.push_back(episode.owes);
  }
  for (size_t e = 0; e < slots_.size(); ++e) {
    if (state.episodes[e].running) PlayAgain(static_cast<int>(e), state.episodes[e]);
  }
}

void Rollout::PlayAgain(int e, const EpisodeState& state) {
  Slot& slot = slots_[static_cast<size_t>(e)];
  std::vector<uint8_t> memory(static_cast<size_t>(layout_.record_bytes()));
  const worlds::ObservationOut unread{layout_.Frame(memory.data()), layout_.Vector(memory.data())};
  slot.episode = state.episode;
  slot.runner.Begin(StreamKeyOf(StreamRole::kTrainEnvironment, e), unread, state.cut_after);
  const auto action_size = static_cast<size_t>(layout_.action_size());
  for (size_t at = 0; at + action_size <= state.actions.size(); at += action_size) {
    slot.runner.Step({state.actions.data() + at, action_size}, unread);
  }
  slot.actions = state.actions;
  selector_.SetNoise(e, state.noise);
}

uint64_t Rollout::StreamKeyOf(StreamRole role, int e) const {
  const uint64_t env = options_.first_env + static_cast<uint64_t>(e);
  return StreamKey(static_cast<uint64_t>(options_.seed), role, env,
                   slots_[static_cast<size_t>(e)].episode);
}

void Rollout::FillHeader(int e, RecordKind kind, RecordHeader* header) const {
  const Slot& slot = slots_[static_cast<size_t>(e)];
  // Actions of the warm-up are uniform and depend on no weights.
  const WeightsVersion version =
      uniform_ && kind == RecordKind::kStep ? WeightsVersion() : selector_.version();
  header->weights_session = version.session;
  header->weights_update = version.update;
  header->time_ns = WallTimeNs();
  header->env = options_.first_env + static_cast<uint32_t>(e);
  header->episode = slot.episode;
  header->index = static_cast<uint32_t>(slot.runner.figures().length);
  header->kind = kind;
  header->version = kRecordVersion;
}

void Rollout::Publish(uint8_t* record) {
  const uint64_t sequence = made_.CountRecord();
  RecordLayout::Header(record).sequence = sequence;
  sink_.EndRecord(sequence);
}

}  // namespace shoal::actor
