// What becomes of a transition under another goal: the desired goal of both observations, and the
// reward, computed by the task's goal half as the actor did, to the last bit. How the episode went
// on, whether it was terminated, stays as it was.
//
// A goal is the achieved goal of a stored record; G its numbers.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/record.h"
#include "common/tasks/task.h"

namespace shoal::replay {

class GoalChange {
 public:
  // CHECK: the records have both goals, and the policy sees the desired one.
  GoalChange(const ObservationSpec& spec, tasks::Task task);

  // The achieved goal (G) of a record, which is borrowed.
  std::span<const float> Achieved(const uint8_t* record) const;
  // Of the step that led to `record`, unscaled.
  float Reward(const uint8_t* record, std::span<const float> goal) const;
  // Into a policy's vector (V).
  void WriteGoal(std::span<const float> goal, std::span<float> observed) const;

 private:
  const RecordLayout layout_;
  const tasks::Task task_;
  ObservationSpec::Range achieved_;  // in a record's vector
  ObservationSpec::Range desired_;   // in the policy's
};

}  // namespace shoal::replay
