#include "learner/update_window.h"

#include <algorithm>

namespace shoal::learner {
namespace {

constexpr float UpdateStats::*kFigures[] = {
    &UpdateStats::critic_loss,      &UpdateStats::actor_loss,
    &UpdateStats::temperature,      &UpdateStats::temperature_loss,
    &UpdateStats::q_mean,           &UpdateStats::target_mean,
    &UpdateStats::entropy,          &UpdateStats::action_saturation,
    &UpdateStats::critic_grad_norm, &UpdateStats::actor_grad_norm,
    &UpdateStats::frame_spread,     &UpdateStats::frozen_cameras};

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

void AddDataAges(std::span<const uint64_t> weights_update, uint64_t updates,
                 QuantileWindow* window) {
  for (const uint64_t chosen : weights_update) {
    window->Add(static_cast<double>(updates - std::min(chosen, updates)));
  }
}

}  // namespace shoal::learner
