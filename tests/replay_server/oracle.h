// Keeps everything and searches: what the replay must agree with.
#pragma once

#include <cstdint>
#include <optional>
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

  // Deals with a record that was not dealt with before.
  void Take(const RecordLayout& layout, uint32_t actor, uint64_t session,
            const std::vector<uint8_t>& bytes, Counts* counts) {
    if (RecordFault(layout, bytes.data()) != nullptr) return void(++counts->rejected);
    const RecordHeader& h = RecordLayout::Header(bytes.data());
    uint64_t prev = 0;
    for (uint64_t id = all.size(); id > 0 && prev == 0 && h.index > 0; --id) {
      const Stored& s = all[id - 1];
      const bool same = s.actor == actor && s.session == session && s.header().env == h.env &&
                        s.header().episode == h.episode && s.header().index + 1 == h.index;
      if (same) prev = id;
    }
    if (h.index > 0 && prev == 0) return void(++counts->after_gap);
    all.push_back({actor, session, prev, bytes});
    ++counts->stored;
  }

  bool Holds(uint64_t id) const { return id > 0 && id <= all.size() && id + capacity > all.size(); }

  // Ids whose frames make the observation that ends at `id`, newest first; nothing when one is
  // gone.
  std::optional<std::vector<uint64_t>> Stack(uint64_t id) const {
    std::vector<uint64_t> ids;
    for (int k = 0; k < stack; ++k) {
      if (!Holds(id)) return std::nullopt;
      ids.push_back(id);
      if (all[id - 1].prev != 0) id = all[id - 1].prev;
    }
    return ids;
  }
  // The `n_step` steps in a row that end at `id`, newest first; nothing when the episode has fewer
  // or one is gone.
  std::optional<std::vector<uint64_t>> Steps(uint64_t id) const {
    std::vector<uint64_t> ids;
    for (int k = 0; k < n_step; ++k) {
      if (!Holds(id) || all[id - 1].prev == 0) return std::nullopt;
      ids.push_back(id);
      id = all[id - 1].prev;
    }
    return ids;
  }
  bool Sampleable(uint64_t id) const {
    const auto steps = Steps(id);
    return steps && Stack(all[steps->back() - 1].prev).has_value();
  }

  uint64_t capacity;
  int stack;
  int n_step = 1;
  std::vector<Stored> all{};  // id = position + 1
};

}  // namespace shoal::replay
