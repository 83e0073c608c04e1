// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sample_figures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "learner/engine/losses.h"

namespace shoal::learner {
namespace {

constexpr double kMinusHalf = -0.5;  // between the two rewards of a sparse task, -1 and 0
constexpr double kWithin = 0.05;     // m

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
  if (!batch.continues.empty()) return;  // rollouts have no such figures
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

}  // namespace shoal::learner
