// SPDX-License-Identifier: Apache-2.0
#include "tests/replay_server/core/batch_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace shoal::replay {

void BatchOracle::CheckElement(const BatchPlan::Element& element, size_t b, const BatchView& view) {
  const uint64_t id = element.id;
  if (element.goal != 0) CheckGoal(element);
  ASSERT_TRUE(oracle_.Sampleable(id)) << "record " << id;
  std::vector<uint64_t> steps = *oracle_.Steps(id);
  const bool terminated = EndUnderGoal(&steps, element.goal);
  const Oracle::Stored &first = oracle_.all[id - 1], &last = oracle_.all[steps.back() - 1];
  const Oracle::Stored& before = oracle_.all[first.prev - 1];
  double reward = 0;
  for (size_t k = 0; k < steps.size(); ++k) {
    const Oracle::Stored& step = oracle_.all[steps[k] - 1];
    reward += std::pow(kDiscount, k) * Earned(step, element.goal);
    CheckContinues(oracle_.all[step.prev - 1], last);
  }
  const uint64_t shown = element.goal != 0 ? element.goal : oracle_.Episode(id).front();
  CheckInput(*oracle_.Stack(first.prev), shown, view.obs_frames, b);
  CheckInput(*oracle_.Stack(steps.back()), shown, view.next_obs_frames, b);
  if (steps.size() < static_cast<size_t>(oracle_.n_step)) ++counts_.short_samples;
  if (before.header().index == 0) ++counts_.first_frame_repeats;
  ASSERT_FLOAT_EQ(view.reward[b], static_cast<float>(reward));
  ASSERT_EQ(view.weights_update[b], first.header().weights_update);
  ASSERT_EQ(view.id[b], id);
  const double bootstrap = terminated ? 0 : std::pow(kDiscount, steps.size() - 1);
  ASSERT_FLOAT_EQ(view.bootstrap[b], static_cast<float>(bootstrap));
  ExpectFloats(layout_.Action(first.bytes.data()), view.action, b);
  ExpectFloats(Observed(before, element.goal), view.obs_vector, b);
  ExpectFloats(Observed(last, element.goal), view.next_obs_vector, b);
  if (!spec_.goal_picture) return;
  ExpectFloats(Wanted(before, element.goal), view.obs_privileged, b);
  ExpectFloats(Wanted(last, element.goal), view.next_obs_privileged, b);
}

bool BatchOracle::EndUnderGoal(std::vector<uint64_t>* steps, uint64_t goal) {
  for (size_t k = 0; k < steps->size(); ++k) {
    const Oracle::Stored& step = oracle_.all[(*steps)[k] - 1];
    const bool ended = (step.header().flags & kTerminated) != 0;
    const bool ends = goal == 0 || !kind_.end_on_success ? ended : EndsUnderGoal(step, goal);
    counts_.went_on += ended && !ends ? 1 : 0;
    if (!ends) continue;
    counts_.ended_by_goal += ended ? 0 : 1;
    steps->resize(k + 1);
    return true;
  }
  return false;
}

bool BatchOracle::EndsUnderGoal(const Oracle::Stored& step, uint64_t goal) const {
  return (step.header().flags & (kTerminated | kSuccess)) == kTerminated ||
         Distance(step, goal) < kThreshold;
}

void BatchOracle::CheckProbabilities(const BatchPlan& plan,
                                     const std::set<uint64_t>& sampleable) const {
  std::map<uint64_t, double> movements;
  double all = 0;
  for (const uint64_t id : sampleable) all += movements[id] = Movement(id);
  ASSERT_GT(all, 0);
  for (const BatchPlan::Element& element : plan.elements) {
    const double expected = (1 - *kind_.movement_share) / static_cast<double>(movements.size()) +
                            *kind_.movement_share * movements.at(element.id) / all;
    ASSERT_NEAR(element.probability, expected, 1e-5 * expected) << "record " << element.id;
  }
}

double BatchOracle::Movement(uint64_t id) const {
  const auto achieved = [&](uint64_t record) {
    return layout_.Vector(oracle_.all[record - 1].bytes.data()).subspan(2, 2);
  };
  const auto distance = [&](uint64_t from, uint64_t to) {
    return std::hypot(double{achieved(to)[0]} - achieved(from)[0],
                      double{achieved(to)[1]} - achieved(from)[1]);
  };
  const std::vector<uint64_t> episode = oracle_.Episode(id);
  if (kind_.movement == MovementKind::kDisplacement) {
    return distance(oracle_.all[id - 1].prev, episode.back());
  }
  double path = 0;
  for (const uint64_t step : episode) {
    if (step >= id) path += distance(oracle_.all[step - 1].prev, step);
  }
  return path;
}

void BatchOracle::CheckGoal(const BatchPlan::Element& element) {
  ++counts_.relabelled;
  const std::vector<uint64_t> episode = oracle_.Episode(element.id);
  ASSERT_TRUE(std::ranges::count(episode, element.goal) == 1 && oracle_.Holds(element.goal));
  ASSERT_NE(oracle_.all[element.goal - 1].header().index, 0u) << "a reset is nothing achieved";
  ASSERT_TRUE(*kind_.hindsight != HindsightGoal::kFuture || element.goal >= element.id);
  ASSERT_TRUE(*kind_.hindsight != HindsightGoal::kFinal || element.goal == episode.back());
  if (element.goal < element.id) ++counts_.goals_before;
}

float BatchOracle::Earned(const Oracle::Stored& step, uint64_t goal) const {
  if (goal == 0) return step.header().reward;
  return Distance(step, goal) > kThreshold ? -1.0f : 0.0f;
}

double BatchOracle::Distance(const Oracle::Stored& step, uint64_t goal) const {
  const auto achieved = layout_.Vector(step.bytes.data()).subspan(2, 2);
  const auto wanted = layout_.Vector(oracle_.all[goal - 1].bytes.data()).subspan(2, 2);
  const double x = double{achieved[0]} - wanted[0], y = double{achieved[1]} - wanted[1];
  return std::sqrt(x * x + y * y);
}

std::vector<float> BatchOracle::Observed(const Oracle::Stored& stored, uint64_t goal) const {
  const auto all = layout_.Vector(stored.bytes.data());
  std::vector<float> observed{all[0], all[1]};
  if (spec_.goal_picture) return observed;
  const std::vector<float> wanted = Wanted(stored, goal);
  observed.insert(observed.end(), wanted.begin(), wanted.end());
  return observed;
}

std::vector<float> BatchOracle::Wanted(const Oracle::Stored& stored, uint64_t goal) const {
  const auto of_goal =
      layout_.Vector(goal == 0 ? stored.bytes.data() : oracle_.all[goal - 1].bytes.data());
  const auto wanted = of_goal.subspan(goal == 0 ? 4 : 2, 2);
  return {wanted.begin(), wanted.end()};
}

void BatchOracle::CheckContinues(const Oracle::Stored& before, const Oracle::Stored& last) {
  ASSERT_EQ(before.header().env, last.header().env);
  ASSERT_EQ(before.header().episode, last.header().episode);
  ASSERT_EQ(before.header().flags & (kTerminated | kTruncated), 0);
}

void BatchOracle::CheckInput(std::vector<uint64_t> newest_first, uint64_t goal,
                             std::span<const uint8_t> frames, size_t b) {
  const size_t frame_bytes = static_cast<size_t>(layout_.frame_bytes());
  std::vector<uint64_t> ids(newest_first.rbegin(), newest_first.rend());
  if (spec_.goal_picture) ids.push_back(goal);
  for (size_t k = 0; k < ids.size(); ++k) {
    const auto expected = layout_.Frame(oracle_.all[ids[k] - 1].bytes.data());
    const auto actual = frames.subspan((b * ids.size() + k) * frame_bytes, frame_bytes);
    ASSERT_TRUE(std::ranges::equal(expected, actual)) << "frame " << k << " of element " << b;
  }
}

void BatchOracle::ExpectFloats(std::span<const float> expected, std::span<const float> all,
                               size_t b) {
  ASSERT_TRUE(std::ranges::equal(expected, all.subspan(b * expected.size(), expected.size())));
}

}  // namespace shoal::replay
