// SPDX-License-Identifier: Apache-2.0
// Actions that the actor program computes with a checkpoint's policy: the reference for policies
// outside of training.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "actor/acting/action_selector.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/run_config.h"
#include "tests/common/policy/checkpoint_fixture.h"

namespace shoal::policy {

// Actions that the evaluation actor would choose, (N, A).
inline std::vector<float> ActorsActions(const RunConfig& run,
                                        const std::filesystem::path& checkpoint,
                                        const RandomObservations& random) {
  actor::ActionSelector selector(run.config, run.spec, random.count);
  selector.Load({{1, 3}, 0, "", ReadFile(checkpoint / kPolicyFile)});
  std::vector<float> actions;
  for (int e = 0; e < random.count; ++e) {
    const auto frames = selector.FrameStackOf(e);
    std::copy_n(random.pixels.begin() + std::ptrdiff_t(e * frames.size()), frames.size(),
                frames.begin());
    const auto vector = selector.VectorOf(e);
    std::copy_n(random.vectors.begin() + std::ptrdiff_t(e * vector.size()), vector.size(),
                vector.begin());
  }
  selector.Select(actor::Acting::kMean);
  for (int e = 0; e < random.count; ++e) {
    actions.insert(actions.end(), selector.ActionOf(e).begin(), selector.ActionOf(e).end());
  }
  return actions;
}

}  // namespace shoal::policy
