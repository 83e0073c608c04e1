// SPDX-License-Identifier: Apache-2.0
// Relabels a transition with another goal: replaces the desired goal in the vectors of the two
// observations, and computes the reward again with the task's goal functions. The result is bit for
// bit the reward that the actor would compute. Terminations do not change, except if episodes end
// on success: then the step that reaches the new goal terminates the episode.
//
// A new goal is the achieved goal of a stored record. If the policy observes goal pictures, the
// frame of this record is the goal picture (batch_gather.h).
//
// Dimensions: G numbers of a goal, V size of the policy's vector, P size of the privileged vector.
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
  // `privileged`: as in BatchOptions. CHECKs that the records have the achieved and the desired
  // goal, and that the policy observes the desired goal, as numbers or as a picture.
  GoalChange(const ObservationSpec& spec, tasks::Task task,
             std::span<const std::string> privileged = {}, bool end_on_success = false);

  // The achieved goal (G) of a record, which is borrowed.
  std::span<const float> Achieved(const uint8_t* record) const;
  // Reward of the step that led to `record`, unscaled.
  float Reward(const uint8_t* record, std::span<const float> goal) const;
  // Whether the step that led to `record` terminates the episode if `goal` is the goal.
  bool Terminated(const uint8_t* record, std::span<const float> goal) const;
  // Writes the goal into a policy's vector (V) and the privileged vector (P; may be empty), if they
  // contain the desired goal.
  void WriteGoal(std::span<const float> goal, std::span<float> observed,
                 std::span<float> privileged) const;

 private:
  const RecordLayout layout_;
  const tasks::Task task_;
  const bool end_on_success_;
  ObservationSpec::Range achieved_;                // achieved goal in a record's vector
  std::optional<ObservationSpec::Range> desired_;  // desired goal in the policy's vector
  std::optional<size_t> privileged_first_;  // start of the desired goal in privileged vectors
};

}  // namespace shoal::replay
