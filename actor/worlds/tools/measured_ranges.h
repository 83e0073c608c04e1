// SPDX-License-Identifier: Apache-2.0
// The range of each number of a task while it was played, and the numbers that never changed. A
// constant number is most often one that the physics half does not write, or writes elsewhere.
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

// Those that had one value in all observations, of which there were more than one. A desired goal
// stays as it is within an episode: its numbers count from two episodes on.
std::vector<ConstantNumber> ConstantNumbers(const tasks::Task& task, const RangeMeter& meter);

// A line of warning for each, for people.
std::string ToText(const std::vector<ConstantNumber>& constant, int observations);
nlohmann::ordered_json ToJson(const std::vector<ConstantNumber>& constant);

}  // namespace shoal::worlds
