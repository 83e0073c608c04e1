// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/stored_episodes.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace shoal::replay {
namespace {

// The stored part of an episode that has not ended yet.
struct Piece {
  std::vector<uint64_t> ids;
  bool from_reset = false;
};

}  // namespace

StoredEpisodes FindEpisodes(const Ring& ring) {
  StoredEpisodes episodes;
  std::unordered_map<uint64_t, Piece> open;  // by the id of their last record
  for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
    const SlotHeader& slot = ring.Slot(id);
    if (slot.id != id) continue;  // overwritten since the snapshot was taken
    Piece piece{.ids = {}, .from_reset = slot.prev == 0};
    if (const auto before = open.extract(slot.prev); !before.empty()) {
      piece = std::move(before.mapped());
    }
    if (ring.Header(id).kind != RecordKind::kGoal) piece.ids.push_back(id);
    const bool ended = (ring.Header(id).flags & (kTerminated | kTruncated)) != 0;
    if (!ended) {
      open.emplace(id, std::move(piece));
    } else if (piece.from_reset) {
      episodes.whole.push_back(std::move(piece.ids));
    } else {
      ++episodes.overwritten;
    }
  }
  for (const auto& [last, piece] : open)
    ++(piece.from_reset ? episodes.unended : episodes.overwritten);
  return episodes;
}

std::optional<std::vector<uint8_t>> CopyEpisode(const Ring& ring,
                                                const std::vector<uint64_t>& ids) {
  const auto bytes = static_cast<size_t>(ring.layout().record_bytes());
  std::vector<uint8_t> records(ids.size() * bytes);
  for (size_t i = 0; i < ids.size(); ++i) {
    std::copy_n(ring.Record(ids[i]), bytes,
                records.begin() + static_cast<std::ptrdiff_t>(i * bytes));
  }
  // Checked after the copy: a record that is intact now was intact while it was copied.
  const bool whole = std::ranges::all_of(ids, [&](uint64_t id) { return ring.Intact(id); });
  if (!whole) return std::nullopt;
  return records;
}

}  // namespace shoal::replay
