// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/rate_limiter.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::replay {

RateLimiter::RateLimiter(const LimiterOptions& options) : options_(options) {
  CHECK(options.samples_per_insert.Least() >= 0 && options.batch > 0 && options.credits > 0);
  Rebuild();
}

double RateLimiter::LeastBand(const LimiterOptions& options, int sessions) {
  return 2 * (Unasked(options, sessions) + static_cast<double>(options.credits) * options.batch);
}

void RateLimiter::Rebuild() {
  band_ = std::max(options_.band, LeastBand(options_, sessions_));
  cursor_ = std::clamp(cursor_, -band_ / 2, band_ / 2);
}

void RateLimiter::SetSessions(int sessions) {
  if (sessions == sessions_) return;
  sessions_ = sessions;
  Rebuild();
}

void RateLimiter::SetSamplesPerInsert(const Schedule& samples_per_insert) {
  CHECK(samples_per_insert.Least() >= 0);
  options_.samples_per_insert = samples_per_insert;
  Rebuild();
}

void RateLimiter::Inserted(uint64_t count, uint64_t sampleable, uint64_t env_steps) {
  if (!Limits() || sampleable <= options_.min_size) return;
  const uint64_t counted = std::min(count, sampleable - options_.min_size);
  CHECK(counted <= env_steps) << counted << " " << env_steps;
  cursor_ += options_.samples_per_insert.Integral(env_steps - counted, env_steps);
  cursor_ = std::min(cursor_, band_ / 2);
}

void RateLimiter::Sampled() {
  if (!Limits()) return;
  cursor_ = std::max(cursor_ - options_.batch, -band_ / 2);
}

bool RateLimiter::MayInsert(uint64_t sampleable) const {
  if (!Limits() || draining_ || sampleable < options_.min_size) return true;
  return cursor_ <= band_ / 2 - Unasked(options_, sessions_);
}

bool RateLimiter::MaySample(uint64_t sampleable) const {
  if (draining_ || options_.lockstep) return sampleable > 0;
  if (sampleable < options_.min_size) return false;
  return !Limits() || cursor_ - options_.batch >= -band_ / 2;
}

}  // namespace shoal::replay
