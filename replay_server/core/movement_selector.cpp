// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/movement_selector.h"

#include <cmath>
#include <span>

#include "common/base/check.h"

namespace shoal::replay {
namespace {

// Longer distances and NaN count as this, so that sums of weights stay exact.
constexpr double kFarthest = 10;  // m

}  // namespace

MovementSelector::MovementSelector(const Ring& ring, const EpisodeIndex& index,
                                   const GoalChange& goals, double share, MovementKind kind)
    : ring_(ring),
      index_(index),
      goals_(goals),
      share_(share),
      kind_(kind),
      uniform_(ring, index),
      weights_(static_cast<size_t>(ring.capacity())),
      ahead_(static_cast<size_t>(ring.capacity())) {
  CHECK(share >= 0 && share <= 1) << share;
}

void MovementSelector::Added(uint64_t id) { weights_.Set(Slot(id), MovementFrom(id)); }

void MovementSelector::Removed(uint64_t id) { weights_.Set(Slot(id), 0); }

std::optional<Selection> MovementSelector::Draw(Random* random) {
  const bool moving = random->Uniform() < share_ && weights_.total() > 0;
  std::optional<Selection> selection;
  if (moving) {
    const size_t slot = weights_.Find(random->Below(weights_.total()));
    selection = Selection{.id = ahead_[slot].id, .probability = 0};
  } else {
    selection = uniform_.Draw(random);
  }
  if (!selection || weights_.total() == 0) return selection;
  const double weight = static_cast<double>(weights_.Get(Slot(selection->id)));
  selection->probability = (1 - share_) / static_cast<double>(index_.sampleable()) +
                           share_ * weight / static_cast<double>(weights_.total());
  return selection;
}

// Walks to the first step whose remaining motion is known, or to the episode's end, and back. Each
// step of an episode is visited once, in whatever order the steps become sampleable.
uint64_t MovementSelector::MovementFrom(uint64_t id) {
  const bool path = kind_ == MovementKind::kPath;
  unknown_.clear();
  uint64_t next = id;
  for (; next != 0 && ahead_[Slot(next)].id != next; next = index_.Next(next)) {
    unknown_.push_back(next);
  }
  const uint64_t at_the_end = path ? 0 : unknown_.empty() ? id : unknown_.back();
  uint64_t value = next == 0 ? at_the_end : ahead_[Slot(next)].value;
  for (auto step = unknown_.rbegin(); step != unknown_.rend(); ++step) {
    if (path) value += Micrometres(*step, *step);
    ahead_[Slot(*step)] = {*step, value};
  }
  return path ? value : Micrometres(id, value);
}

uint64_t MovementSelector::Micrometres(uint64_t from, uint64_t to) const {
  const std::span<const float> after = goals_.Achieved(ring_.Record(to));
  const std::span<const float> before = goals_.Achieved(ring_.Record(index_.Previous(from)));
  double squares = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const double difference = double{after[i]} - double{before[i]};
    squares += difference * difference;
  }
  const double distance = std::sqrt(squares);
  return static_cast<uint64_t>(std::llround(1e6 * (distance < kFarthest ? distance : kFarthest)));
}

}  // namespace shoal::replay
