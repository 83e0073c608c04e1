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
  // Numbers of elements checked so far.
  struct Counts {
    uint64_t first_frame_repeats = 0;
    uint64_t short_samples = 0;  // fewer than n steps, because the last step terminated the episode
    uint64_t relabelled = 0;     // samples with a hindsight goal
    uint64_t goals_before = 0;   // samples whose goal was achieved before the sample began
    // ended_by_goal: samples that ended at a step that reached the hindsight goal. went_on: steps
    // that ended their episode, but do not end it under the hindsight goal.
    uint64_t ended_by_goal = 0, went_on = 0;
  };

  BatchOracle(const ReplayCase& kind, const Oracle& oracle)
      : kind_(kind), spec_(SpecOf(kind)), layout_(spec_), oracle_(oracle) {}

  // Checks element b of a batch.
  void CheckElement(const BatchPlan::Element& element, size_t b, const BatchView& view);
  // Checks the probabilities: movement_share of the samples are drawn in proportion to the
  // remaining motion, the other samples uniformly from `sampleable`.
  void CheckProbabilities(const BatchPlan& plan, const std::set<uint64_t>& sampleable) const;
  const Counts& counts() const { return counts_; }

 private:
  // Cuts a sample after the first step that ends the episode under the goal. Returns whether there
  // is such a step.
  bool EndUnderGoal(std::vector<uint64_t>* steps, uint64_t goal);
  // Whether a step ends the episode under the goal. If the world ended the episode, it has ended
  // under every goal.
  bool EndsUnderGoal(const Oracle::Stored& step, uint64_t goal) const;
  // Movement of the achieved goal from this step to the end of the episode.
  double Movement(uint64_t id) const;
  // Checks that the goal is stored, in the same episode, and at a step allowed by the hindsight
  // kind.
  void CheckGoal(const BatchPlan::Element& element);
  // The reward: the sparse reward for the goal of record `goal` if `goal` is an id, else the
  // recorded reward.
  float Earned(const Oracle::Stored& step, uint64_t goal) const;
  double Distance(const Oracle::Stored& step, uint64_t goal) const;
  // The observed numbers. The script has three blocks of 2 numbers. The second block, the achieved
  // goal, is only recorded. The third block, the desired goal, is only recorded if a picture shows
  // the goal.
  std::vector<float> Observed(const Oracle::Stored& stored, uint64_t goal) const;
  std::vector<float> Wanted(const Oracle::Stored& stored, uint64_t goal) const;
  // Checks that no sample crosses the end of an episode: `before` belongs to the episode of `last`
  // and did not end this episode.
  void CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last);
  // Compares the frames of the ids (newest first), and the frame of the goal, with element b of
  // `frames`, where the oldest frame is first and the goal is last.
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
