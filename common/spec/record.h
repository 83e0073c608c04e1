// SPDX-License-Identifier: Apache-2.0
// A record: the data that an actor publishes about one environment at one instant. Chunks carry the
// same bytes over DDS, and the replay's ring stores them.
//
//   RecordHeader (80 bytes) | action (A) f32 | drawn action (A or 0) f32 | vector (R) f32
//   | frame (C, H, W) u8 | pad to 8
//
// A *reset* record contains the first observation of an episode; action and reward are zero. A
// *step* record contains the action, its reward, and the observation after the action. If the
// policy observes a goal picture, a *goal* record precedes each reset record. The frame of the goal
// record is the goal picture; the other fields are the same as in the reset record. The vector
// contains every block of the spec, observed or not. The drawn action is present if the spec has
// drawn_actions. All numbers are little-endian. docs/wire_format.md describes the layout byte by
// byte.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal {

inline constexpr uint8_t kRecordVersion = 2;

enum class RecordKind : uint8_t { kReset = 1, kStep = 2, kGoal = 3 };

enum RecordFlags : uint8_t {
  kTerminated = 1,  // the task ended: no bootstrap
  kTruncated = 2,   // a time limit ended the episode: bootstrap
  kSuccess = 4,
};

struct RecordHeader {
  uint64_t sequence;         // per (actor, session), from 1, without gaps
  uint64_t weights_session;  // session of the weights that chose the action; 0 = uniform random
  uint64_t weights_update;   // update of these weights
  int64_t time_ns;           // wall time at which the record was made
  uint32_t env;      // global index of the environment; does not depend on the actor that runs it
  uint32_t episode;  // per env, from 0, never re-used within a run
  uint32_t index;    // 0 = reset or goal record; k = record of the k-th step
  float reward;
  float distance;  // distance to the goal in m in this observation; NaN if the task has none
  RecordKind kind;
  uint8_t flags;  // RecordFlags
  uint8_t version;
  uint8_t reserved;
  float log_prob;  // log-probability of the drawn action under its policy; 0 without drawn actions
  uint32_t reserved_words[5];
};
static_assert(sizeof(RecordHeader) == 80);

// Offsets of the parts of a record under one spec. A value type; cheap to copy.
class RecordLayout {
 public:
  explicit RecordLayout(const ObservationSpec& spec);

  int action_size() const { return action_size_; }
  int vector_size() const { return vector_size_; }  // R
  int frame_bytes() const { return frame_bytes_; }
  // Bytes before the frame.
  int prefix_bytes() const { return frame_offset_; }
  // Size of one record, a multiple of 8.
  int record_bytes() const { return record_bytes_; }

  // The functions below return views into a record of record_bytes() bytes, aligned to 8 bytes. The
  // views borrow the record.
  static RecordHeader& Header(uint8_t* record) { return *reinterpret_cast<RecordHeader*>(record); }
  static const RecordHeader& Header(const uint8_t* record) {
    return *reinterpret_cast<const RecordHeader*>(record);
  }
  std::span<float> Action(uint8_t* record) const {
    return {reinterpret_cast<float*>(record + sizeof(RecordHeader)), size_t(action_size_)};
  }
  std::span<const float> Action(const uint8_t* record) const {
    return {reinterpret_cast<const float*>(record + sizeof(RecordHeader)), size_t(action_size_)};
  }
  // The drawn action before clipping; empty if the spec has no drawn actions.
  std::span<float> DrawnAction(uint8_t* record) const {
    return {reinterpret_cast<float*>(record + drawn_offset_), size_t(drawn_size_)};
  }
  std::span<const float> DrawnAction(const uint8_t* record) const {
    return {reinterpret_cast<const float*>(record + drawn_offset_), size_t(drawn_size_)};
  }
  std::span<float> Vector(uint8_t* record) const {
    return {reinterpret_cast<float*>(record + vector_offset_), size_t(vector_size_)};
  }
  std::span<const float> Vector(const uint8_t* record) const {
    return {reinterpret_cast<const float*>(record + vector_offset_), size_t(vector_size_)};
  }
  std::span<uint8_t> Frame(uint8_t* record) const {
    return {record + frame_offset_, size_t(frame_bytes_)};
  }
  std::span<const uint8_t> Frame(const uint8_t* record) const {
    return {record + frame_offset_, size_t(frame_bytes_)};
  }

 private:
  int action_size_, drawn_size_, vector_size_, frame_bytes_;
  int drawn_offset_, vector_offset_, frame_offset_, record_bytes_;
};

// Returns the fault of a received record as text, or nullptr if the record is valid. Faults: a
// wrong version or kind, an index that does not fit the kind, unknown flags, a reward or
// log-probability that is not finite, an action outside [-1, 1], a drawn action or vector that is
// not finite.
const char* RecordFault(const RecordLayout& layout, const uint8_t* record);

}  // namespace shoal
