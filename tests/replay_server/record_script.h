// SPDX-License-Identifier: Apache-2.0
// Records whose bytes are functions of their actor, environment and step, so that tests can
// distinguish them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/config/run_config.h"
#include "common/spec/record.h"
#include "common/wire/messages.h"

namespace shoal::replay {

// A spec with small and odd sizes, so that record sizes are not multiples of powers of two.
inline ObservationSpec TinySpec(int stack, int height = 3, int width = 5) {
  ObservationSpec spec;
  spec.task = "Test";
  spec.cameras = {"a", "b"};
  spec.channels = 2;
  spec.height = height;
  spec.width = width;
  spec.stack = stack;
  spec.blocks = {{"grip", 2}, {"achieved_goal", 2, /*observed=*/false}, {"desired_goal", 2}};
  spec.action_size = 2;
  spec.model_fingerprint = "fingerprint";
  return spec;
}

// The spec if the policy gets a picture of the goal in place of the goal's numbers.
inline ObservationSpec WithGoalPicture(ObservationSpec spec) {
  spec.goal_picture = true;
  for (BlockSpec& block : spec.blocks) block.observed &= block.name != "desired_goal";
  return spec;
}

inline RunConfig TinyRun(int stack, int64_t capacity) {
  RunConfig run;
  run.spec = TinySpec(stack);
  run.config.run_name = "tiny";
  run.config.actors = 1;
  run.config.replay.storage = "memory";
  run.config.replay.capacity = capacity;
  run.config.replay.min_size = 4;
  run.config.replay.samples_per_insert = Schedule::Constant(0);
  run.config.replay.shift_pad = 0;
  run.config.replay.window_chunks = 2;
  run.config.learner.batch = 8;
  run.config.transport.chunk_records = 4;
  return run;
}

// Makes one record. Pixels, vector, action and reward are functions of (actor, env, episode,
// index).
inline std::vector<uint8_t> MakeRecord(const ObservationSpec& spec, uint32_t actor, uint32_t env,
                                       uint32_t episode, uint32_t index, uint64_t sequence,
                                       uint8_t flags = 0) {
  const RecordLayout layout(spec);
  // Records are read through casts to 8-byte fields. The memory of a vector is aligned accordingly.
  std::vector<uint8_t> record(static_cast<size_t>(layout.record_bytes()));
  Random random(HashWords({actor, env, episode, index}));
  RecordHeader& header = RecordLayout::Header(record.data());
  header.sequence = sequence;
  header.weights_update = random.Below(1000);
  header.env = env;
  header.episode = episode;
  header.index = index;
  header.kind = index == 0 ? RecordKind::kReset : RecordKind::kStep;
  header.flags = flags;
  header.version = kRecordVersion;
  for (uint8_t& pixel : layout.Frame(record.data())) pixel = static_cast<uint8_t>(random.Next());
  for (float& v : layout.Vector(record.data())) v = static_cast<float>(random.Uniform(-2, 2));
  if (index == 0) return record;
  header.reward = static_cast<float>(random.Uniform(-1, 1));
  for (float& a : layout.Action(record.data())) a = static_cast<float>(random.Uniform(-1, 1));
  return record;
}

// The goal record of an episode; its pixels are unique.
inline std::vector<uint8_t> MakeGoalRecord(const ObservationSpec& spec, uint32_t actor,
                                           uint32_t env, uint32_t episode, uint64_t sequence) {
  constexpr uint32_t kNoStep = 1'000'000;
  std::vector<uint8_t> record = MakeRecord(spec, actor, env, episode, 0, sequence);
  const std::vector<uint8_t> other = MakeRecord(spec, actor, env, episode, kNoStep, sequence);
  const RecordLayout layout(spec);
  std::ranges::copy(layout.Frame(other.data()), layout.Frame(record.data()).begin());
  RecordLayout::Header(record.data()).kind = RecordKind::kGoal;
  return record;
}

// Records of an actor session in which `envs` environments step in turn. Episodes have random
// lengths and are terminated (half of them by success) or truncated. If the spec has a goal
// picture, episodes begin with a goal record. Sequences start at 1; equal arguments give equal
// records.
class RecordScript {
 public:
  RecordScript(const ObservationSpec& spec, uint32_t actor, uint64_t session, uint32_t envs = 2,
               int mean_length = 6)
      : spec_(spec),
        actor_(actor),
        session_(session),
        envs_(envs),
        mean_length_(mean_length),
        random_(HashWords({actor, session})) {}

  uint32_t actor() const { return actor_; }
  uint64_t session() const { return session_; }

  // The record with this sequence.
  const std::vector<uint8_t>& At(uint64_t sequence) {
    while (records_.size() < sequence) Make();
    return records_[sequence - 1];
  }

  // Records first .. first+count-1 as a chunk. Valid until the next call.
  TransitionChunk Chunk(uint64_t first, uint32_t count) {
    payload_.clear();
    for (uint32_t k = 0; k < count; ++k) {
      const std::vector<uint8_t>& record = At(first + k);
      payload_.insert(payload_.end(), record.begin(), record.end());
    }
    return {.spec_hash = spec_.Hash(),
            .actor = actor_,
            .count = count,
            .session = session_,
            .first_sequence = first,
            .payload = payload_};
  }

  // Makes the record malformed: its action is out of range.
  void Spoil(uint64_t sequence) {
    At(sequence);
    const RecordLayout layout(spec_);
    layout.Action(records_[sequence - 1].data())[0] = 2;
  }

 private:
  void Make() {
    const uint64_t sequence = records_.size() + 1;
    const uint32_t env = actor_ * envs_ + static_cast<uint32_t>(random_.Below(envs_));
    Where& where = where_[env];
    const bool begins = where.ended;
    if (begins) where = {.episode = where.episode + 1, .index = 0, .ended = false};
    uint8_t flags = 0;
    if (where.index > 0 && random_.Below(static_cast<uint64_t>(mean_length_)) == 0) {
      flags = static_cast<uint8_t>(1 + random_.Below(3));
      const bool success = (flags & kTerminated) != 0 && sequence % 2 == 0;
      flags = static_cast<uint8_t>(flags | (success ? kSuccess : 0));
      where.ended = true;
    }
    // The episode number contains the session, because episode numbers are unique within a run.
    const uint32_t episode = static_cast<uint32_t>(session_ * 1000) + where.episode;
    if (begins && spec_.goal_picture) {
      records_.push_back(MakeGoalRecord(spec_, actor_, env, episode, sequence));
      return;  // the next record of this environment is the reset
    }
    records_.push_back(MakeRecord(spec_, actor_, env, episode, where.index, sequence, flags));
    ++where.index;
  }

  struct Where {
    uint32_t episode = 0, index = 0;
    bool ended = true;
  };

  const ObservationSpec spec_;
  const uint32_t actor_;
  const uint64_t session_;
  const uint32_t envs_;
  const int mean_length_;
  Random random_;
  std::map<uint32_t, Where> where_;
  std::vector<std::vector<uint8_t>> records_;
  std::vector<uint8_t> payload_;
};

}  // namespace shoal::replay
