// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sample_figures.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shoal::learner {
namespace {

constexpr double kMinusHalf = -0.5;  // between the two rewards of a sparse task, -1 and 0
constexpr double kWithin = 0.05;     // m

struct Summary {
  double mean = 0, deviation = 0, least = 0, most = 0;
};

Summary Summarise(std::span<const float> values) {
  double sum = 0, squares = 0;
  for (const float value : values) sum += value;
  const double mean = sum / double(values.size());
  for (const float value : values) squares += (value - mean) * (value - mean);
  const auto [least, most] = std::ranges::minmax(values);
  return {mean, std::sqrt(squares / double(values.size())), least, most};
}

double Share(std::span<const float> values, auto&& counts) {
  return double(std::ranges::count_if(values, counts)) / double(values.size());
}

std::vector<float> GoalDistances(const BatchView& batch, const ObservationSpec& spec) {
  const auto achieved = spec.Observed("achieved_goal"), desired = spec.Observed("desired_goal");
  std::vector<float> distances;
  if (!achieved || !desired || achieved->size != desired->size) return distances;
  const auto vector_size = size_t(spec.VectorSize());
  for (size_t b = 0; b < batch.reward.size(); ++b) {
    const float* vector = &batch.next_obs_vector[b * vector_size];
    double squares = 0;
    for (int i = 0; i < achieved->size; ++i) {
      const double apart = vector[achieved->first + i] - vector[desired->first + i];
      squares += apart * apart;
    }
    distances.push_back(float(std::sqrt(squares)));
  }
  return distances;
}

}  // namespace

void AddSampleFigures(const BatchView& batch, const ObservationSpec& spec, UpdateFigures* figures) {
  if (!batch.continues.empty()) return;  // a rollout
  const Summary reward = Summarise(batch.reward);
  figures->Set(kRewardMean, reward.mean);
  figures->Set(kRewardStd, reward.deviation);
  figures->Set(kRewardMin, reward.least);
  figures->Set(kRewardMax, reward.most);
  figures->Set(kRewardAboveMinusHalf,
               Share(batch.reward, [](float value) { return value > kMinusHalf; }));
  const std::vector<float> distances = GoalDistances(batch, spec);
  if (distances.empty()) return;
  const Summary distance = Summarise(distances);
  figures->Set(kGoalDistanceMean, distance.mean);
  figures->Set(kGoalDistanceStd, distance.deviation);
  figures->Set(kGoalDistanceMin, distance.least);
  figures->Set(kGoalDistanceMax, distance.most);
  figures->Set(kGoalWithin, Share(distances, [](float value) { return value < kWithin; }));
}

void AddValueFigures(int batch, std::span<const float* const> q, UpdateFigures* figures) {
  const auto of = [&](size_t i) { return Summarise({q[i], size_t(batch)}); };
  const Summary first = of(0);
  figures->Set(kQ1Mean, first.mean);
  figures->Set(kQ1Std, first.deviation);
  if (q.size() > 1) {
    const Summary second = of(1);
    figures->Set(kQ2Mean, second.mean);
    figures->Set(kQ2Std, second.deviation);
  }
  std::vector<float> smallest(q[0], q[0] + batch);
  for (const float* values : q.subspan(1)) {
    for (size_t b = 0; b < smallest.size(); ++b) smallest[b] = std::min(smallest[b], values[b]);
  }
  const Summary least = Summarise(smallest);
  figures->Set(kQMinMean, least.mean);
  figures->Set(kQMinStd, least.deviation);
  figures->Set(kQMinMin, least.least);
  figures->Set(kQMinMax, least.most);
}

}  // namespace shoal::learner
