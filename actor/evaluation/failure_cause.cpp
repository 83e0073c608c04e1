// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/failure_cause.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/check.h"

namespace shoal::actor {
namespace {

constexpr double kFallen = 0.05, kTouched = 0.01, kLifted = 0.03, kOnTheTable = 0.01;  // m
constexpr double kTipped = 30 * std::numbers::pi / 180;                                // rad

constexpr FailureCause kOfObjects[] = {
    FailureCause::kNotFinite,     FailureCause::kLeftTheTable,    FailureCause::kNeverTouched,
    FailureCause::kNotLifted,     FailureCause::kDropped,         FailureCause::kTipped,
    FailureCause::kPassedTheGoal, FailureCause::kReachedThenLeft, FailureCause::kMovedAway,
    FailureCause::kBesideTheGoal, FailureCause::kStoppedShort};
constexpr FailureCause kOfReaching[] = {FailureCause::kNotFinite, FailureCause::kReachedThenLeft,
                                        FailureCause::kMovedAway, FailureCause::kStoppedShort};

double Distance(const std::array<double, 3>& one, const std::array<double, 3>& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

}  // namespace

std::string_view NameOf(FailureCause cause) {
  switch (cause) {
    case FailureCause::kNotFinite:
      return "not_finite";
    case FailureCause::kLeftTheTable:
      return "left_the_table";
    case FailureCause::kNeverTouched:
      return "never_touched";
    case FailureCause::kNotLifted:
      return "not_lifted";
    case FailureCause::kDropped:
      return "dropped";
    case FailureCause::kTipped:
      return "tipped";
    case FailureCause::kPassedTheGoal:
      return "passed_the_goal";
    case FailureCause::kReachedThenLeft:
      return "reached_then_left";
    case FailureCause::kMovedAway:
      return "moved_away";
    case FailureCause::kBesideTheGoal:
      return "beside_the_goal";
    case FailureCause::kStoppedShort:
      return "stopped_short";
  }
  CHECK(false) << static_cast<int>(cause);
  return "";
}

FailureFacts::FailureFacts(const ObservationSpec& spec, const tasks::Task& task)
    : threshold_(task.distance_threshold()) {
  // A Point holds at most three numbers.
  if (task.goal_size() == 0 || task.goal_size() > 3) return;
  const auto achieved = spec.Recorded(task.achieved_goal().name);
  const auto desired = spec.Recorded(task.desired_goal().name);
  if (!achieved || !desired) return;
  applies_ = true;
  achieved_ = *achieved;
  desired_ = *desired;
  const auto object = spec.Recorded("object");
  has_object_ = object && object->size == 3 && task.goal_size() == 3;
  const auto angle = spec.Recorded("object_angle");
  if (has_object_ && angle && angle->size == 3) angle_ = *angle;
}

std::span<const FailureCause> FailureFacts::causes() const {
  if (!has_object_) return kOfReaching;
  return kOfObjects;
}

FailureFacts::Point FailureFacts::Read(std::span<const float> vector,
                                       const ObservationSpec::Range& block) const {
  Point point{};
  std::copy_n(vector.begin() + block.first, block.size, point.begin());
  return point;
}

std::vector<double> FailureFacts::Numbers(const Point& point) const {
  return {point.begin(), point.begin() + desired_.size};
}

void FailureFacts::Begin(std::span<const float> vector) {
  if (!applies_) return;
  start_ = now_ = Read(vector, achieved_);
  goal_ = Read(vector, desired_);
  nearest_ = first_distance_ = Distance(start_, goal_);
  farthest_moved_ = highest_ = lowest_ = most_tilted_ = 0;
}

void FailureFacts::Step(std::span<const float> vector) {
  if (!applies_) return;
  now_ = Read(vector, achieved_);
  nearest_ = std::min(nearest_, Distance(now_, goal_));
  farthest_moved_ = std::max(farthest_moved_, Distance(now_, start_));
  highest_ = std::max(highest_, now_[2] - start_[2]);
  lowest_ = std::min(lowest_, now_[2] - start_[2]);
  if (!angle_) return;
  // Height of the object's up axis, seen from the world. `angle` holds Euler angles about x, y, z.
  const Point angle = Read(vector, *angle_);
  const double up = std::cos(angle[0]) * std::cos(angle[1]);
  most_tilted_ = std::max(most_tilted_, std::acos(std::clamp(up, -1.0, 1.0)));
}

bool FailureFacts::Lifts() const { return goal_[2] - start_[2] > threshold_; }

FailureCause FailureFacts::CauseOfObject() const {
  // Several causes may apply. The first one in this order counts.
  if (lowest_ <= -kFallen) return FailureCause::kLeftTheTable;
  if (farthest_moved_ < kTouched) return FailureCause::kNeverTouched;
  if (Lifts() && highest_ < kLifted) return FailureCause::kNotLifted;
  if (Lifts() && now_[2] - start_[2] < kOnTheTable) return FailureCause::kDropped;
  if (most_tilted_ >= kTipped) return FailureCause::kTipped;
  // Displacement along the straight line from the start to the goal.
  double along = 0;
  for (size_t i = 0; i < 3; ++i) along += (now_[i] - start_[i]) * (goal_[i] - start_[i]);
  along /= std::max(first_distance_, 1e-9);
  if (along - first_distance_ >= threshold_) return FailureCause::kPassedTheGoal;
  if (nearest_ < threshold_) return FailureCause::kReachedThenLeft;
  if (Distance(now_, goal_) >= first_distance_) return FailureCause::kMovedAway;
  const double moved = Distance(now_, start_);
  const double beside = std::sqrt(std::max(0.0, moved * moved - along * along));
  return beside > first_distance_ - along ? FailureCause::kBesideTheGoal
                                          : FailureCause::kStoppedShort;
}

FailureCause FailureFacts::Cause() const {
  CHECK(applies_);
  if (has_object_) return CauseOfObject();
  if (nearest_ < threshold_) return FailureCause::kReachedThenLeft;
  return Distance(now_, goal_) >= first_distance_ ? FailureCause::kMovedAway
                                                  : FailureCause::kStoppedShort;
}

}  // namespace shoal::actor
