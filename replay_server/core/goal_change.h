// SPDX-License-Identifier: Apache-2.0
// Relabels a transition with another goal: replaces the desired goal in the vectors of both
// observations, and recomputes the reward with the task's goal functions. The computation is the
// actor's, bit for bit. Whether the episode terminated does not change, unless episodes end on
// success: then the step that reaches the new goal terminates the episode.
//
// A goal is the achieved goal of a stored record; G: its size. If goals are shown in pictures, the
// frame of the record is the goal picture (batch_gather.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/spec/record.h"
#include "common/tasks/task.h"

namespace shoal::replay {

class GoalChange {
 public:
  // `privileged`: as in BatchOptions. CHECK: the records have both goals, and the policy sees the
  // desired goal, as numbers or in a picture.
  GoalChange(const ObservationSpec& spec, tasks::Task task,
             std::span<const std::string> privileged = {}, bool end_on_success = false);

  // The achieved goal (G) of a record, which is borrowed.
  std::span<const float> Achieved(const uint8_t* record) const;
  // Reward of the step that led to `record`, unscaled.
  float Reward(const uint8_t* record, std::span<const float> goal) const;
  // Whether the step that led to `record` would have ended the episode, apart from time limits.
  bool Terminated(const uint8_t* record, std::span<const float> goal) const;
  // Writes the goal into a policy's vector (V) and the privileged vector (P; may be empty), if they
  // contain the desired goal.
  void WriteGoal(std::span<const float> goal, std::span<float> observed,
                 std::span<float> privileged) const;

 private:
  const RecordLayout layout_;
  const tasks::Task task_;
  const bool end_on_success_;
  ObservationSpec::Range achieved_;                // in a record's vector
  std::optional<ObservationSpec::Range> desired_;  // in the policy's
  std::optional<size_t> privileged_first_;         // in the privileged one
};

}  // namespace shoal::replay
