#include "learner/update_window.h"

#include <algorithm>
#include <cmath>

namespace shoal::learner {
namespace {

constexpr float UpdateStats::*kFigures[] = {
    &UpdateStats::critic_loss,      &UpdateStats::actor_loss,
    &UpdateStats::temperature,      &UpdateStats::temperature_loss,
    &UpdateStats::q_mean,           &UpdateStats::target_mean,
    &UpdateStats::entropy,          &UpdateStats::action_saturation,
    &UpdateStats::critic_grad_norm, &UpdateStats::actor_grad_norm,
    &UpdateStats::frame_spread};

}  // namespace

void UpdateWindow::Add(const UpdateStats& stats) {
  ++updates_;
  for (const auto figure : kFigures) sum_.*figure += stats.*figure;
}

UpdateStats UpdateWindow::Mean() const {
  UpdateStats mean = sum_;
  if (updates_ == 0) return mean;
  for (const auto figure : kFigures) mean.*figure /= static_cast<float>(updates_);
  return mean;
}

PolicyLag ComputePolicyLag(std::span<const uint64_t> weights_update, uint64_t updates) {
  if (weights_update.empty()) return {};
  std::vector<uint64_t> lags;
  lags.reserve(weights_update.size());
  for (const uint64_t chosen : weights_update) lags.push_back(updates - std::min(chosen, updates));
  std::ranges::sort(lags);
  const auto percentile = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(lags.size()));
    return static_cast<double>(lags[static_cast<size_t>(std::max(rank, 1.0)) - 1]);
  };
  return {percentile(0.5), percentile(0.95)};
}

}  // namespace shoal::learner
