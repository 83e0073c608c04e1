// SPDX-License-Identifier: Apache-2.0
// A simple reference for the replay: keeps every record and finds records by search.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/spec/record.h"

namespace shoal::replay {

struct Oracle {
  struct Stored {
    uint32_t actor;
    uint64_t session, prev;  // prev: id, 0 = none
    std::vector<uint8_t> bytes;
    const RecordHeader& header() const { return RecordLayout::Header(bytes.data()); }
  };
  struct Counts {
    uint64_t stored = 0, rejected = 0, after_gap = 0;
  };

  // Processes a new record.
  void Take(const RecordLayout& layout, uint32_t actor, uint64_t session,
            const std::vector<uint8_t>& bytes, Counts* counts) {
    const RecordHeader& h = RecordLayout::Header(bytes.data());
    if (RecordFault(layout, bytes.data()) != nullptr) {
      Cut(actor, session, h.env);
      return void(++counts->rejected);
    }
    const bool begins = h.kind == (goal_pictures ? RecordKind::kGoal : RecordKind::kReset);
    uint64_t prev = 0;
    for (uint64_t id = all.size(); id > 0 && prev == 0 && !begins; --id) {
      const Stored& s = all[id - 1];
      const bool same = s.actor == actor && s.session == session && s.header().env == h.env &&
                        s.header().episode == h.episode && Precedes(s.header(), h) &&
                        !overwritten_ends.contains(id);
      if (same) prev = id;
    }
    if (!begins && prev == 0) {
      Cut(actor, session, h.env);
      return void(++counts->after_gap);
    }
    if (begins && newest.contains(h.env)) ended.insert(newest[h.env]);
    all.push_back({actor, session, prev, bytes});
    newest[h.env] = all.size();
    if ((h.flags & (kTerminated | kTruncated)) != 0) ended.insert(all.size());
    ++counts->stored;
  }

  // Whether `one` directly precedes `other`. The order is goal, reset, steps by index.
  static bool Precedes(const RecordHeader& one, const RecordHeader& other) {
    if (other.kind == RecordKind::kReset) return one.kind == RecordKind::kGoal;
    return one.kind != RecordKind::kGoal && one.index + 1 == other.index;
  }

  // Ends the episode of the environment at its newest record if the episode belongs to this
  // session.
  void Cut(uint32_t actor, uint64_t session, uint32_t env) {
    const uint64_t id = newest.contains(env) ? newest[env] : 0;
    if (id != 0 && all[id - 1].actor == actor && all[id - 1].session == session) ended.insert(id);
  }

  // Simulates a restart. The restarted server has only the records in the ring. In the ring an
  // episode has ended if its last record has a flag or if a later episode of the environment
  // exists.
  void ReadAnew() {
    for (const auto& [env, id] : newest) {
      if ((all[id - 1].header().flags & (kTerminated | kTruncated)) == 0) ended.erase(id);
      if (!Holds(id)) overwritten_ends.insert(id);
    }
  }

  // Records of the episode of `id`, oldest first, whether or not the ring holds them.
  std::vector<uint64_t> Episode(uint64_t id) const {
    while (all[id - 1].prev != 0) id = all[id - 1].prev;
    std::vector<uint64_t> ids{id};
    for (uint64_t later = id + 1; later <= all.size(); ++later) {
      if (all[later - 1].prev == ids.back()) ids.push_back(later);
    }
    return ids;
  }

  bool Holds(uint64_t id) const { return id > 0 && id <= all.size() && id + capacity > all.size(); }

  // Ids of the frames of the observation at `id`, newest first; empty if a frame was overwritten.
  std::optional<std::vector<uint64_t>> Stack(uint64_t id) const {
    std::vector<uint64_t> ids;
    for (int k = 0; k < stack; ++k) {
      if (!Holds(id)) return std::nullopt;
      ids.push_back(id);
      if (all[id - 1].header().kind == RecordKind::kStep) id = all[id - 1].prev;
    }
    return ids;
  }
  // The steps of the sample that begins with `id`, oldest first: n_step steps, or the steps up to a
  // termination. Empty if `id` was overwritten or is not a step, or if the episode has fewer steps.
  std::optional<std::vector<uint64_t>> Steps(uint64_t id) const {
    if (!Holds(id) || all[id - 1].header().kind != RecordKind::kStep) return std::nullopt;
    std::vector<uint64_t> ids{id};
    for (uint64_t later = id + 1; later <= all.size() && !Whole(ids); ++later) {
      if (all[later - 1].prev == ids.back()) ids.push_back(later);
    }
    return Whole(ids) ? std::optional(ids) : std::nullopt;
  }
  bool Whole(const std::vector<uint64_t>& ids) const {
    return ids.size() == static_cast<size_t>(n_step) ||
           (all[ids.back() - 1].header().flags & kTerminated) != 0;
  }
  bool Sampleable(uint64_t id) const {
    if (!Holds(id)) return false;
    if (goal_pictures && !Holds(Episode(id).front())) return false;
    if (whole_episodes && !ended.contains(Episode(id).back())) return false;
    return Steps(id) && Stack(all[id - 1].prev).has_value();
  }

  uint64_t capacity;
  int stack;
  int n_step = 1;
  bool whole_episodes = false;
  bool goal_pictures = false;             // the first record of each episode is a goal record
  std::vector<Stored> all{};              // id = position + 1
  std::map<uint32_t, uint64_t> newest{};  // by env
  std::set<uint64_t> ended{};             // newest records of episodes that have ended
  std::set<uint64_t> overwritten_ends{};  // newest records that were overwritten at a restart
};

}  // namespace shoal::replay
