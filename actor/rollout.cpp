#include "actor/rollout.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::actor {

Rollout::Rollout(const Config& config, const ObservationSpec& spec,
                 std::vector<std::unique_ptr<worlds::Environment>> environments, uint32_t first_env,
                 MadePage& made, ChunkWindow& window, ActionSelector& selector)
    : seed_(static_cast<uint64_t>(config.seed)),
      layout_(spec),
      first_env_(first_env),
      made_(made),
      window_(window),
      selector_(selector) {
  for (size_t e = 0; e < environments.size(); ++e) {
    slots_.push_back({.environment = std::move(environments[e]),
                      .stack = FrameStack(selector.FrameStackOf(int(e)), spec.FrameBytes()),
                      .figures = {},
                      .actions = {}});
  }
}

bool Rollout::TryStep() {
  const int envs = static_cast<int>(slots_.size());
  if (window_.Room() < 2 * slots_.size()) return false;
  {
    const ScopedSeconds timed(environment_seconds_);
    for (int e = 0; e < envs; ++e) {
      if (!slots_[size_t(e)].running) BeginEpisode(e);
    }
  }
  {
    const ScopedSeconds timed(inference_seconds_);
    selector_.Select(/*deterministic=*/false);
  }
  {
    const ScopedSeconds timed(environment_seconds_);
    for (int e = 0; e < envs; ++e) StepOne(e);
  }
  env_steps_ += slots_.size();
  return true;
}

StageSeconds Rollout::seconds() const {
  StageSeconds seconds;
  for (const Slot& slot : slots_) seconds.rendering += slot.environment->render_seconds();
  seconds.physics = environment_seconds_ - seconds.rendering;
  seconds.inference = inference_seconds_;
  return seconds;
}

void Rollout::BeginEpisode(int e) {
  Slot& slot = slots_[size_t(e)];
  const uint64_t env = first_env_ + static_cast<uint64_t>(e);
  slot.episode = made_.TakeEpisode(static_cast<uint32_t>(e));
  slot.figures = {};
  slot.running = true;
  slot.actions.clear();
  selector_.BeginEpisode(e, StreamKey(seed_, StreamRole::kTrainPolicy, env, slot.episode));

  uint8_t* record = window_.BeginRecord();
  const std::span<uint8_t> frame = layout_.Frame(record);
  const std::span<float> vector = layout_.Vector(record);
  RecordHeader& header = RecordLayout::Header(record);
  FillHeader(e, RecordKind::kReset, &header);
  header.distance = slot.environment->Reset(
      StreamKey(seed_, StreamRole::kTrainEnvironment, env, slot.episode), {frame, vector});
  const auto masses = slot.environment->drawn_masses();
  slot.figures.drawn_masses.assign(masses.begin(), masses.end());
  slot.stack.Reset(frame);
  std::copy(vector.begin(), vector.end(), selector_.VectorOf(e).begin());
  Publish(record);
}

void Rollout::StepOne(int e) {
  Slot& slot = slots_[size_t(e)];
  uint8_t* record = window_.BeginRecord();
  const std::span<uint8_t> frame = layout_.Frame(record);
  const std::span<float> vector = layout_.Vector(record);
  const std::span<const float> action = selector_.ActionOf(e);
  std::copy(action.begin(), action.end(), layout_.Action(record).begin());
  slot.actions.insert(slot.actions.end(), action.begin(), action.end());
  const worlds::StepResult result = slot.environment->Step(action, {frame, vector});

  ++slot.figures.length;
  slot.figures.episode_return += result.reward;
  RecordHeader& header = RecordLayout::Header(record);
  FillHeader(e, RecordKind::kStep, &header);
  header.reward = result.reward;
  header.distance = result.distance;
  header.flags =
      static_cast<uint8_t>((result.terminated ? kTerminated : 0) |
                           (result.truncated ? kTruncated : 0) | (result.success ? kSuccess : 0));
  slot.stack.Push(frame);
  std::copy(vector.begin(), vector.end(), selector_.VectorOf(e).begin());
  Publish(record);

  if (result.terminated || result.truncated) {
    slot.figures.success = result.success;
    slot.figures.final_distance = result.distance;
    episodes_.Add(slot.figures);
    slot.running = false;
  }
}

RolloutState Rollout::State() const {
  RolloutState state;
  state.env_steps = env_steps_;
  for (int e = 0; e < static_cast<int>(slots_.size()); ++e) {
    const Slot& slot = slots_[size_t(e)];
    state.episodes.push_back({.episode = slot.episode,
                              .running = slot.running,
                              .noise = selector_.NoiseOf(e),
                              .actions = slot.running ? slot.actions : std::vector<float>()});
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
  for (size_t e = 0; e < slots_.size(); ++e) {
    if (state.episodes[e].running) PlayAgain(static_cast<int>(e), state.episodes[e]);
  }
}

void Rollout::PlayAgain(int e, const EpisodeState& state) {
  Slot& slot = slots_[size_t(e)];
  std::vector<uint8_t> memory(static_cast<size_t>(layout_.record_bytes()));
  const std::span<uint8_t> frame = layout_.Frame(memory.data());
  const std::span<float> vector = layout_.Vector(memory.data());
  const auto observed = [&] {
    std::copy(vector.begin(), vector.end(), selector_.VectorOf(e).begin());
  };
  const uint64_t env = first_env_ + static_cast<uint64_t>(e);
  slot.environment->Reset(StreamKey(seed_, StreamRole::kTrainEnvironment, env, state.episode),
                          {frame, vector});
  slot.stack.Reset(frame);
  observed();
  const size_t action_size = layout_.Action(memory.data()).size();
  for (size_t at = 0; at + action_size <= state.actions.size(); at += action_size) {
    const worlds::StepResult result =
        slot.environment->Step({state.actions.data() + at, action_size}, {frame, vector});
    slot.stack.Push(frame);
    observed();
    ++slot.figures.length;
    slot.figures.episode_return += result.reward;
  }
  slot.episode = state.episode;
  slot.running = true;
  slot.actions = state.actions;
  selector_.SetNoise(e, state.noise);
}

void Rollout::FillHeader(int e, RecordKind kind, RecordHeader* header) const {
  const Slot& slot = slots_[size_t(e)];
  header->weights_session = selector_.version().session;
  header->weights_update = selector_.version().update;
  header->time_ns = WallTimeNs();
  header->env = first_env_ + static_cast<uint32_t>(e);
  header->episode = slot.episode;
  header->index = static_cast<uint32_t>(slot.figures.length);
  header->kind = kind;
  header->version = kRecordVersion;
}

void Rollout::Publish(uint8_t* record) {
  const uint64_t sequence = made_.CountRecord();
  RecordLayout::Header(record).sequence = sequence;
  window_.EndRecord(sequence);
}

}  // namespace shoal::actor
