// SPDX-License-Identifier: Apache-2.0
// Checks drawn batches against an oracle that keeps everything.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "common/spec/observation_spec.h"
#include "common/spec/record.h"
#include "common/wire/batch_schema.h"
#include "replay_server/core/batch_gather.h"
#include "tests/replay_server/core/replay_case.h"
#include "tests/replay_server/oracle.h"

namespace shoal::replay {

// Fails the test that runs, fatally, if a batch is not as the oracle says. Borrows the oracle.
class BatchOracle {
 public:
  // Elements checked so far.
  struct Counts {
    uint64_t first_frame_repeats = 0;
    uint64_t short_samples = 0;  // fewer steps, because the last one terminated the episode
    uint64_t relabelled = 0;     // samples with a goal of hindsight
    uint64_t goals_before = 0;   // samples whose goal was achieved before they began
    // Samples with a goal of hindsight that a step ended because it reached that goal, and steps
    // that ended their episode but not under that goal.
    uint64_t ended_by_goal = 0, went_on = 0;
  };

  BatchOracle(const ReplayCase& kind, const Oracle& oracle)
      : kind_(kind), spec_(SpecOf(kind)), layout_(spec_), oracle_(oracle) {}

  // Element b of a batch.
  void CheckElement(const BatchPlan::Element& element, size_t b, const BatchView& view);
  // The share of movement_share by what still moves, the rest uniformly over `sampleable`.
  void CheckProbabilities(const BatchPlan& plan, const std::set<uint64_t>& sampleable) const;
  const Counts& counts() const { return counts_; }

 private:
  // Cuts a sample off behind the first step that ends the episode under the goal; whether one does.
  bool EndUnderGoal(std::vector<uint64_t>* steps, uint64_t goal);
  // An episode that the world ended has ended under every goal.
  bool EndsUnderGoal(const Oracle::Stored& step, uint64_t goal) const;
  // Movement of the achieved goal from that step to its episode's end.
  double Movement(uint64_t id) const;
  // The goal is a stored one of the same episode, at a step that the kind of hindsight allows.
  void CheckGoal(const BatchPlan::Element& element);
  // Sparse, against the goal of record `goal`, if that is one.
  float Earned(const Oracle::Stored& step, uint64_t goal) const;
  double Distance(const Oracle::Stored& step, uint64_t goal) const;
  // The script has three blocks of 2 numbers. The second, the achieved goal, is recorded only; so
  // is the third, the desired goal, if a picture shows it.
  std::vector<float> Observed(const Oracle::Stored& stored, uint64_t goal) const;
  std::vector<float> Wanted(const Oracle::Stored& stored, uint64_t goal) const;
  // Never across an episode's end: `before` is of the same episode and did not end it.
  void CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last);
  // `newest_first` ids, and the one that shows the goal, against element b of `frames`, which has
  // the oldest frame first and the goal last.
  void CheckInput(std::vector<uint64_t> newest_first, uint64_t goal,
                  std::span<const uint8_t> frames, size_t b);
  void ExpectFloats(std::span<const float> expected, std::span<const float> all, size_t b);

  const ReplayCase kind_;
  const ObservationSpec spec_;
  const RecordLayout layout_;
  const Oracle& oracle_;
  Counts counts_;
};

}  // namespace shoal::replay
