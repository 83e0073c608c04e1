#include "actor/rollout.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
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
                      .figures = {}});
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
