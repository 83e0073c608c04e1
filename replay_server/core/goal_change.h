// SPDX-License-Identifier: Apache-2.0
// Relabels a transition with another goal: the desired goal of both observations, at its place in
// their vectors, and the reward, computed by the task's goal half as the actor did, to the last
// bit. The termination of the episode stays, unless episodes end on success: then the step that
// reaches the new goal terminates it.
//
// A goal is the achieved goal of a stored record; G its numbers. Where goals are shown in pictures,
// that record's frame is the goal's: batch_gather.h.
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
  // `privileged`: as BatchOptions has it. CHECK: the records have both goals, and the policy sees
  // the desired one, as numbers or in a picture.
  GoalChange(const ObservationSpec& spec, tasks::Task task,
             std::span<const std::string> privileged = {}, bool end_on_success = false);

  // The achieved goal (G) of a record, which is borrowed.
  std::span<const float> Achieved(const uint8_t* record) const;
  // Reward of the step that led to `record`, unscaled.
  float Reward(const uint8_t* record, std::span<const float> goal) const;
  // Whether that step would have ended the episode, time limits apart.
  bool Terminated(const uint8_t* record, std::span<const float> goal) const;
  // Into a policy's vector (V) and the privileged one (P; may be empty), where they have it.
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
