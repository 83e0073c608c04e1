// SPDX-License-Identifier: Apache-2.0
#include "launch/run/evaluation_filter.h"

namespace shoal::launch {

bool EvaluationFilter::Accept(const EvaluationPoint& point) {
  const WeightsVersion version{point.learner_session, point.updates};
  const std::pair<uint64_t, uint64_t> name{point.env_steps, point.updates};
  if (!version.NewerThan(newest_) || counted_.contains(name)) {
    ++repeated_;
    return false;
  }
  newest_ = version;
  counted_.insert(name);
  return true;
}

}  // namespace shoal::launch
