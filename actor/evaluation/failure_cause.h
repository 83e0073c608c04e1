// SPDX-License-Identifier: Apache-2.0
// Cause of an episode's failure, computed from the achieved and desired goals in its records.
//
//   p_0, p_t, p_T   achieved goal at the start, after step t, at the end      g   desired goal
//   d_t = |p_t - g|                                                           D   task's threshold
//   along = (p_T - p_0) (g - p_0) / |g - p_0|                                 all in m
//
// A failed episode has the first cause that fits; the z axis points up:
//
//   not_finite            a number of the simulation was not finite: the episode was faulty
//
//   with an object (a block `object` is recorded; p is its position)
//     left_the_table      some p_t is 5 cm or more below p_0
//     never_touched       no p_t is 1 cm or more from p_0
//     not_lifted          g is more than D above p_0, and no p_t 3 cm above p_0
//     dropped             g is more than D above p_0, and p_T is within 1 cm of p_0's height
//     tipped              object_angle turned its up axis by 30 degrees or more away from upright
//     passed_the_goal     along exceeds |g - p_0| by D or more
//     reached_then_left   some d_t < D
//     moved_away          d_T >= d_0
//     beside_the_goal     the distance of p_T from the line p_0 g exceeds |g - p_0| - along
//     stopped_short       in all other cases
//   without an object
//     reached_then_left, moved_away, stopped_short
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/spec/observation_spec.h"
#include "common/tasks/task.h"

namespace shoal::actor {

enum class FailureCause {
  kNotFinite,
  kLeftTheTable,
  kNeverTouched,
  kNotLifted,
  kDropped,
  kTipped,
  kPassedTheGoal,
  kReachedThenLeft,
  kMovedAway,
  kBesideTheGoal,
  kStoppedShort,
};

// Name of a cause in files: "left_the_table".
std::string_view NameOf(FailureCause cause);

// Facts about one episode, collected observation by observation. One thread.
class FailureFacts {
 public:
  // Supports tasks with goals of up to three numbers in m; `applies()` is false for other tasks.
  FailureFacts(const ObservationSpec& spec, const tasks::Task& task);

  bool applies() const { return applies_; }
  // The causes that an episode of the task can have, in the order in which they are tested.
  std::span<const FailureCause> causes() const;

  // `vector` (R): all blocks, as Environment writes them.
  void Begin(std::span<const float> vector);
  void Step(std::span<const float> vector);
  // The desired goal, and the achieved goal at the last observation, in m. The size is that of the
  // goal.
  std::vector<double> desired() const { return Numbers(goal_); }
  std::vector<double> achieved() const { return Numbers(now_); }
  // The cause of an episode that has ended without success and without a fault. CHECK: `applies()`,
  // and Begin was called.
  FailureCause Cause() const;

 private:
  using Point = std::array<double, 3>;  // goals of fewer numbers are padded with zeros

  Point Read(std::span<const float> vector, const ObservationSpec::Range& block) const;
  std::vector<double> Numbers(const Point& point) const;
  bool Lifts() const;  // the goal is above the table
  FailureCause CauseOfObject() const;

  bool applies_ = false, has_object_ = false;
  ObservationSpec::Range achieved_, desired_;
  std::optional<ObservationSpec::Range> angle_;
  double threshold_ = 0;  // D
  Point start_{}, now_{}, goal_{};
  double nearest_ = 0, first_distance_ = 0;               // d_t
  double farthest_moved_ = 0, highest_ = 0, lowest_ = 0;  // p_t relative to p_0
  double most_tilted_ = 0;                                // rad
};

}  // namespace shoal::actor
