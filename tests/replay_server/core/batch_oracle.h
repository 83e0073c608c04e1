// SPDX-License-Identifier: Apache-2.0
// Checks drawn batches against an oracle that keeps every record.
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

// Fails the running test, fatally, if a batch differs from the oracle. Borrows the oracle.
class BatchOracle {
 public:
  // Elements checked so far.
  struct Counts {
    uint64_t first_frame_repeats = 0;
    uint64_t short_samples = 0;  // fewer steps, because the last one terminated the episode
    uint64_t relabelled = 0;     // samples with a hindsight goal
    uint64_t goals_before = 0;   // samples whose goal was achieved before they began
    // Samples that ended at a step that reached their hindsight goal, and steps that ended their
    // episode but not under the hindsight goal.
    uint64_t ended_by_goal = 0, went_on = 0;
  };

  BatchOracle(const ReplayCase& kind, const Oracle& oracle)
      : kind_(kind), spec_(SpecOf(kind)), layout_(spec_), oracle_(oracle) {}

  // Element b of a batch.
  void CheckElement(const BatchPlan::Element& element, size_t b, const BatchView& view);
  // Checks probabilities: movement_share of the samples in proportion to the remaining motion, the
  // rest uniformly over `sampleable`.
  void CheckProbabilities(const BatchPlan& plan, const std::set<uint64_t>& sampleable) const;
  const Counts& counts() const { return counts_; }

 private:
  // Cuts a sample off after the first step that ends the episode under the goal. Returns whether
  // there is such a step.
  bool EndUnderGoal(std::vector<uint64_t>* steps, uint64_t goal);
  // An episode that the world ended has ended under every goal.
  bool EndsUnderGoal(const Oracle::Stored& step, uint64_t goal) const;
  // Movement of the achieved goal from this step to the end of the episode.
  double Movement(uint64_t id) const;
  // Checks that the goal is stored, in the same episode, and at a step allowed by the hindsight
  // kind.
  void CheckGoal(const BatchPlan::Element& element);
  // The reward: sparse for the goal of record `goal` if `goal` is an id, else the recorded one.
  float Earned(const Oracle::Stored& step, uint64_t goal) const;
  double Distance(const Oracle::Stored& step, uint64_t goal) const;
  // The script has three blocks of 2 numbers. The second, the achieved goal, is recorded only; so
  // is the third, the desired goal, if a picture shows it.
  std::vector<float> Observed(const Oracle::Stored& stored, uint64_t goal) const;
  std::vector<float> Wanted(const Oracle::Stored& stored, uint64_t goal) const;
  // Checks that no sample crosses the end of an episode: `before` belongs to it and did not end it.
  void CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last);
  // Compares the frames of the ids (newest first), and that of the goal, with element b of
  // `frames`, which has the oldest frame first and the goal last.
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
