// SPDX-License-Identifier: Apache-2.0
// Measured range of each number of a task during play, and the numbers that never changed. If a
// number never changes, the physics half usually does not write the number, or writes it to another
// place.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/tasks/task.h"

namespace shoal::worlds {

struct MeasuredRange {
  double low = 0, high = 0;
};

// Ranges of all numbers of OpenEnvironment::numbers(): state vector, achieved goal, desired goal.
class RangeMeter {
 public:
  explicit RangeMeter(const tasks::Task& task);

  void OnReset(std::span<const float> numbers);
  void OnStep(std::span<const float> numbers) { Include(numbers); }

  const std::vector<MeasuredRange>& ranges() const { return ranges_; }
  int observations() const { return observations_; }
  int episodes() const { return episodes_; }

 private:
  void Include(std::span<const float> numbers);

  std::vector<MeasuredRange> ranges_;
  int observations_ = 0, episodes_ = 0;
};

struct ConstantNumber {
  std::string block, name;
  double value = 0;
};

// The numbers that had the same value in all observations; empty if there are fewer than two
// observations. Desired goals are constant within an episode, so their numbers are only included if
// two or more episodes were played.
std::vector<ConstantNumber> ConstantNumbers(const tasks::Task& task, const RangeMeter& meter);

// The warnings as text, one line for each number.
std::string ToText(const std::vector<ConstantNumber>& constant, int observations);
nlohmann::ordered_json ToJson(const std::vector<ConstantNumber>& constant);

}  // namespace shoal::worlds
