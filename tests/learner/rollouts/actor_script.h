// SPDX-License-Identifier: Apache-2.0
// Records of an actor of an on-policy run, written by a test.
#pragma once

#include <cstdint>
#include <vector>

#include "common/spec/record.h"
#include "common/wire/messages.h"
#include "tests/learner/training_fixture.h"

namespace shoal::learner {

inline constexpr WeightsVersion kFirst{100, 0};

// Records of one actor, whose environments take turns.
class ActorScript {
 public:
  ActorScript(const ObservationSpec& spec, uint32_t actor, uint64_t session)
      : layout_(spec), spec_hash_(spec.Hash()), actor_(actor), session_(session) {}

  void Reset(uint32_t env, uint32_t episode, float observation) {
    uint8_t* record = Add(env, episode, 0, RecordKind::kReset);
    for (float& x : layout_.Vector(record)) x = observation;
  }
  // Adds a step to `observation`; the reward equals the observation.
  void Step(uint32_t env, uint32_t episode, uint32_t index, float observation,
            const WeightsVersion& version = kFirst, uint8_t flags = 0) {
    uint8_t* record = Add(env, episode, index, RecordKind::kStep);
    RecordHeader& header = RecordLayout::Header(record);
    header.weights_session = version.session;
    header.weights_update = version.update;
    header.reward = observation;
    header.log_prob = -observation;
    header.flags = flags;
    for (float& x : layout_.Vector(record)) x = observation;
    for (float& x : layout_.DrawnAction(record)) x = 2 * observation;
  }
  // Adds a reset and three steps.
  void PlayThree(uint32_t env, uint32_t episode, const WeightsVersion& version = kFirst) {
    Reset(env, episode, 1);
    for (uint32_t i = 1; i <= 3; ++i) Step(env, episode, i, float(i + 1), version);
  }
  // The records that were added since the last chunk.
  TransitionChunk Chunk() {
    sent_ = std::move(records_);
    records_.clear();
    const auto count = sent_.size() * 8 / size_t(layout_.record_bytes());
    const uint64_t first = next_ - count;
    return {.spec_hash = spec_hash_,
            .actor = actor_,
            .count = uint32_t(count),
            .session = session_,
            .first_sequence = first,
            .payload = {reinterpret_cast<const uint8_t*>(sent_.data()), sent_.size() * 8}};
  }

 private:
  uint8_t* Add(uint32_t env, uint32_t episode, uint32_t index, RecordKind kind) {
    const size_t words = size_t(layout_.record_bytes()) / 8;
    records_.resize(records_.size() + words);
    auto* record = reinterpret_cast<uint8_t*>(records_.data() + records_.size() - words);
    RecordHeader& header = RecordLayout::Header(record);
    header.sequence = next_++;
    header.env = env;
    header.episode = episode;
    header.index = index;
    header.kind = kind;
    header.version = kRecordVersion;
    return record;
  }

  const RecordLayout layout_;
  const uint64_t spec_hash_;
  const uint32_t actor_;
  const uint64_t session_;
  std::vector<uint64_t> records_, sent_;
  uint64_t next_ = 1;
};

inline ObservationSpec PpoSpec() {
  ObservationSpec spec = SmallRun().spec;
  spec.drawn_actions = true;
  return spec;
}

// Configuration with rollouts of three steps and `actors` actors of one environment each.
inline RunConfig PpoRun(int actors) {
  RunConfig run = SmallRun();
  run.config.learner.algorithm = "ppo";
  run.config.ppo.rollout_steps = run.config.learner.batch = 3;
  run.config.actors = actors;
  run.config.envs_per_actor = 1;
  run.spec = PpoSpec();
  return run;
}

}  // namespace shoal::learner
