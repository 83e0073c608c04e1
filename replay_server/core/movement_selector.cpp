// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/movement_selector.h"

#include <cmath>
#include <span>

#include "common/base/check.h"

namespace shoal::replay {
namespace {

// What moves farther in one step, or is no number, counts as this: sums of weights stay exact.
constexpr double kFarthest = 10;  // m

}  // namespace

MovementSelector::MovementSelector(const Ring& ring, const EpisodeIndex& index,
                                   const GoalChange& goals, double share)
    : ring_(ring),
      index_(index),
      goals_(goals),
      share_(share),
      uniform_(ring, index),
      weights_(static_cast<size_t>(ring.capacity())),
      movements_(static_cast<size_t>(ring.capacity())) {
  CHECK(share >= 0 && share <= 1) << share;
}

void MovementSelector::Added(uint64_t id) { weights_.Set(Slot(id), MovementFrom(id)); }

void MovementSelector::Removed(uint64_t id) { weights_.Set(Slot(id), 0); }

std::optional<Selection> MovementSelector::Draw(Random* random) {
  const bool moving = random->Uniform() < share_ && weights_.total() > 0;
  std::optional<Selection> selection;
  if (moving) {
    const size_t slot = weights_.Find(random->Below(weights_.total()));
    selection = Selection{.id = movements_[slot].id, .probability = 0};
  } else {
    selection = uniform_.Draw(random);
  }
  if (!selection || weights_.total() == 0) return selection;
  const double weight = static_cast<double>(weights_.Get(Slot(selection->id)));
  selection->probability = (1 - share_) / static_cast<double>(index_.sampleable()) +
                           share_ * weight / static_cast<double>(weights_.total());
  return selection;
}

// On to the first step whose movement is known, or the episode's end, and back: each step of an
// episode is looked at once, whichever comes first.
uint64_t MovementSelector::MovementFrom(uint64_t id) {
  unknown_.clear();
  uint64_t next = id;
  for (; next != 0 && movements_[Slot(next)].id != next; next = index_.Next(next)) {
    unknown_.push_back(next);
  }
  uint64_t movement = next == 0 ? 0 : movements_[Slot(next)].micrometres;
  for (auto step = unknown_.rbegin(); step != unknown_.rend(); ++step) {
    movement += MovementOf(*step);
    movements_[Slot(*step)] = {*step, movement};
  }
  return movement;
}

uint64_t MovementSelector::MovementOf(uint64_t id) const {
  const std::span<const float> after = goals_.Achieved(ring_.Record(id));
  const std::span<const float> before = goals_.Achieved(ring_.Record(index_.Previous(id)));
  double squares = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const double difference = double{after[i]} - double{before[i]};
    squares += difference * difference;
  }
  const double distance = std::sqrt(squares);
  return static_cast<uint64_t>(std::llround(1e6 * (distance < kFarthest ? distance : kFarthest)));
}

}  // namespace shoal::replay
