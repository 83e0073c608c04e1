// SPDX-License-Identifier: Apache-2.0
// Motion sampling: a share of the samples is drawn in proportion to the movement of the achieved
// goal in the rest of the episode. The other samples are drawn uniformly.
//
//   path:          movement(s) = sum over the steps k = s, ..., T of |achieved_k - achieved_(k-1)|
//   displacement:  movement(s) = |achieved_T - achieved_(s-1)|
//
// where T is the episode's last step. An object that moves between the fingers and returns to its
// old place has a path but no displacement; hindsight learns from displacement.
//
// In tasks that move an object, an untrained policy does not touch the object in most steps, and
// every goal of hindsight is then reached from the start. Energy-based prioritisation (Zhao and
// Tresp 2018, arXiv:1810.01363) also prefers samples by movement; its weight is the energy of an
// episode. The weight here belongs to a step, depends on the rest of the episode, and needs neither
// mass nor time.
#pragma once

#include <cstdint>
#include <vector>

#include "replay_server/core/episode_index.h"
#include "replay_server/core/goal_change.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"
#include "replay_server/core/uniform_selector.h"
#include "replay_server/core/weight_tree.h"

namespace shoal::replay {

enum class MovementKind { kPath, kDisplacement };

// The episodes of samples must have ended: use an EpisodeIndex with whole_episodes. Movement is a
// whole number of micrometres, and does not depend on records before the step's observation.
// Therefore a restarted server with the same ring draws the same samples. If no achieved goal
// moves, all samples are drawn uniformly.
class MovementSelector final : public Selector {
 public:
  // Borrows ring, index and goals. share: in [0, 1].
  MovementSelector(const Ring& ring, const EpisodeIndex& index, const GoalChange& goals,
                   double share, MovementKind kind = MovementKind::kPath);

  // Bytes of memory for a ring of `capacity` records.
  static constexpr uint64_t Bytes(uint64_t capacity) {
    return WeightTree::Bytes(capacity) + capacity * sizeof(Ahead);
  }

  void Added(uint64_t id) override;
  void Removed(uint64_t id) override;
  std::optional<Selection> Draw(Random* random) override;
  uint64_t redraws() const override { return uniform_.redraws(); }

 private:
  // Movement ahead of a step.
  struct Ahead {
    uint64_t id = 0;  // id of the step
    // kPath: micrometres until the end of the episode. kDisplacement: id of the episode's last
    // step.
    uint64_t value = 0;
  };

  size_t Slot(uint64_t id) const { return static_cast<size_t>(id % ring_.capacity()); }
  // Movement from step `id` to the end of its episode, which must have ended. The predecessor of
  // `id` must be stored.
  uint64_t MovementFrom(uint64_t id);
  // Distance between the achieved goals before step `from` and after step `to`, in micrometres.
  uint64_t Micrometres(uint64_t from, uint64_t to) const;

  const Ring& ring_;
  const EpisodeIndex& index_;
  const GoalChange& goals_;
  const double share_;
  const MovementKind kind_;
  UniformSelector uniform_;
  WeightTree weights_;             // by slot; 0 = cannot be drawn
  std::vector<Ahead> ahead_;       // by slot; an entry with another id is not computed yet
  std::vector<uint64_t> unknown_;  // temporary memory of MovementFrom
};

}  // namespace shoal::replay
