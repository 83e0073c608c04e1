// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/episode_log.h"

#include <cmath>

namespace shoal::actor {

void EpisodeLog::Add(const EpisodeFigures& figures) {
  ++count_;
  recent_.push_back(figures);
  if (recent_.size() > kWindow) recent_.pop_front();
}

EpisodeFigures EpisodeLog::Mean() const {
  EpisodeFigures mean;
  if (recent_.empty()) return mean;
  const double n = static_cast<double>(recent_.size());
  double length = 0;
  mean.drawn_masses = recent_.back().drawn_masses;
  for (worlds::DrawnMass& drawn : mean.drawn_masses) drawn.mass_kg = 0;
  for (const EpisodeFigures& figures : recent_) {
    mean.episode_return += figures.episode_return / n;
    mean.final_distance += figures.final_distance / n;
    mean.action_smoothness += figures.action_smoothness / n;
    length += figures.length / n;
    for (size_t i = 0; i < mean.drawn_masses.size(); ++i) {
      mean.drawn_masses[i].mass_kg += figures.drawn_masses[i].mass_kg / n;
    }
  }
  mean.length = static_cast<int>(std::lround(length));
  return mean;
}

double EpisodeLog::SuccessRate() const {
  if (recent_.empty()) return 0;
  double successes = 0;
  for (const EpisodeFigures& figures : recent_) successes += figures.success;
  return successes / static_cast<double>(recent_.size());
}

}  // namespace shoal::actor
